//! What tells one cap from another: the parameters of its shape and its fabric.

/// Smallest and largest value of a parameter.
pub type Range = (f64, f64);

macro_rules! shape {
    ($($(#[$doc:meta])* $field:ident,)*) => {
        /// The parameters of one cap, or with another `T` something about each of them, such
        /// as the ranges of a template. Lengths are in metres, angles in radians.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Shape<T = f64> {
            $($(#[$doc])* pub $field: T,)*
        }

        impl<T> Shape<T> {
            /// The same for each parameter, made by `f`, in the order of the fields.
            pub fn map<U>(&self, mut f: impl FnMut(&T) -> U) -> Shape<U> {
                Shape { $($field: f(&self.$field),)* }
            }
        }
    };
}

shape! {
    /// Length of the hem.
    circumference,
    /// Breadth of the hem oval over its length.
    oval,
    /// How much fuller the oval is behind than in front, relative to its breadth.
    egg,
    /// Height of the apex over the hem plane; of an open crown, where its apex would be.
    height,
    /// Exponent of the crown's profile at the apex: below 2 pointed, above 2 flat.
    apex_exponent,
    /// Exponent of the crown's profile at the hem: above 2 the walls stand steep.
    wall_exponent,
    /// Added to `wall_exponent` in front: the stiffened panels stand up.
    front_structure,
    /// How far the apex lies in front of the hem's centre.
    apex_forward,
    /// How far the apex lies to the right: no cap is symmetric.
    apex_right,
    /// How far the crown's front bulges beyond the hem.
    overhang,
    /// How far the hem rises in the middle of the front.
    front_lift,
    /// How far the hem's back lies under its front.
    hem_tilt,
    /// How flat the panels lie between their seams, relative to the radius.
    panel_flatness,
    /// Amplitude of the crown's smooth irregularities, relative to the radius.
    unevenness,
    /// Phase of the irregularities.
    phase,
    /// Height of the button.
    button,
    /// Width of the band that an open crown consists of.
    band,
    /// Half width of the strap hole at the band.
    strap_hole,
    /// Length of the brim, in front where it has one.
    brim_length,
    /// Half of the angle of the hem that carries a front brim.
    brim_half_angle,
    /// Exponent of a front brim's outline: 2 round, 4 square.
    brim_squareness,
    /// Direction in which a front brim grows: 0 away from the hem, 1 straight forward.
    brim_forwardness,
    /// Fall of the brim along its length.
    brim_slope,
    /// How far a front brim's sides hang below its middle.
    brim_side_drop,
    /// How far the brim's tip bends down in addition to its slope.
    brim_tip_drop,
    /// Area density of the crown's fabric, kg/m2.
    crown_density,
    /// Area density of the brim, kg/m2.
    brim_density,
    /// Bending stiffness of the crown's fabric as a power of ten, N m.
    crown_bending_exponent,
    /// Bending stiffness of the brim as a power of ten, N m.
    brim_bending_exponent,
    /// Frequency with which the whole cap returns to its shape, hertz.
    softness_hz,
}
