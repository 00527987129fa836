//! The plugins of this crate as a dynamic library.

seeone_plugin::export_plugins! {
    Kinematics "qp-ik" => seeone_qp_ik::QpIk::from_setup,
    Kinematics "damped-least-squares" => seeone_qp_ik::DampedLeastSquares::from_setup,
}
