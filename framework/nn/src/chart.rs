//! A learning curve as a picture.

use crate::curve::Curve;
use std::fmt::Write as _;

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 320.0;
/// Left of the axis, and everywhere else.
const MARGINS: [f64; 2] = [48.0, 28.0];
/// Points of the drawn line: each is the mean of its share of the curve.
const POINTS: usize = 120;
const TICKS: usize = 5;

/// `curve` as an SVG document with the loss over the samples seen; empty without a point.
pub fn svg(title: &str, curve: &Curve) -> String {
    let points = thinned(curve.points());
    let Some(&(last, _)) = points.last() else { return String::new() };
    let top = points.iter().map(|p| p.1).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let x = |samples: f64| MARGINS[0] + (WIDTH - MARGINS[0] - MARGINS[1]) * samples / last;
    let y = |loss: f64| HEIGHT - MARGINS[1] - (HEIGHT - 2.0 * MARGINS[1]) * loss / top;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
         font-family=\"sans-serif\" font-size=\"11\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{}\" y=\"18\" font-size=\"13\">{title}: loss over samples</text>\n",
        MARGINS[0]
    );
    for tick in 0..=TICKS {
        let share = tick as f64 / TICKS as f64;
        let (samples, loss) = (share * last, share * top);
        let (across, up) = (x(samples), y(loss));
        let (left, bottom) = (MARGINS[0], HEIGHT - MARGINS[1]);
        let _ = writeln!(
            text,
            "<path d=\"M{left} {up:.1}H{:.1}\" stroke=\"#ddd\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{loss:.2}</text>\
             <text x=\"{across:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{samples:.0}</text>",
            WIDTH - MARGINS[1],
            left - 6.0,
            up + 4.0,
            bottom + 16.0
        );
    }
    let line: Vec<String> =
        points.iter().map(|(s, l)| format!("{:.1},{:.1}", x(*s), y(*l))).collect();
    let _ = writeln!(
        text,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#1f5fa8\" stroke-width=\"1.5\"/>\n</svg>",
        line.join(" ")
    );
    text
}

/// At most [`POINTS`] points, each the mean of a run of the given ones.
fn thinned(points: &[(u64, f64)]) -> Vec<(f64, f64)> {
    let run = points.len().div_ceil(POINTS).max(1);
    let mean = |run: &[(u64, f64)]| {
        let count = run.len() as f64;
        let sum = run.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 as f64, sum.1 + p.1));
        (sum.0 / count, sum.1 / count)
    };
    points.chunks(run).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_a_falling_line_of_few_points() {
        let mut curve = Curve::default();
        assert_eq!(svg("nothing", &curve), "");
        (1..=1000).for_each(|n| curve.push(128 * n, 4.0 / n as f64));
        let text = svg("nst coarse", &curve);
        let line = text.split("points=\"").nth(1).and_then(|t| t.split('"').next()).expect("line");
        let points: Vec<(f64, f64)> = line
            .split(' ')
            .map(|p| p.split_once(',').expect("two numbers"))
            .map(|(x, y)| (x.parse().expect("x"), y.parse().expect("y")))
            .collect();
        assert!(points.len() <= POINTS && points.len() > POINTS / 2);
        assert!(points.windows(2).all(|p| p[0].0 < p[1].0 && p[0].1 <= p[1].1), "down is larger");
        assert!(points.iter().all(|p| (0.0..WIDTH).contains(&p.0) && (0.0..HEIGHT).contains(&p.1)));
    }
}
