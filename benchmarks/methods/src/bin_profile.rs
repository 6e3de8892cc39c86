#[path = "../../../examples/methods/problems.rs"]
#[allow(dead_code)]
mod problems;
use mbg_runtime::*;
use nalgebra::SVector;
use problems::*;
fn main() {
    let which = std::env::args().nth(1).unwrap_or_default();
    for _ in 0..20 {
        let mut best = f64::INFINITY;
        let mut stat = Statistics::default();
        for _ in 0..200 {
            let t = std::time::Instant::now();
            let x = SVector::from([2.0, 0.0]);
            let mut s = 0.0;
            stat = match which.as_str() {
                "radau" => Adaptive::new(Radau5, 1e-6, 1e-6).integrate(&Written(VanDerPol), &(), 0.0, 2.0, x, |step| s = step.state()[0]),
                "rodas4" => Adaptive::new(Rodas4, 1e-6, 1e-6).integrate(&Written(VanDerPol), &(), 0.0, 2.0, x, |step| s = step.state()[0]),
                _ => Adaptive::new(Rodas5P, 1e-6, 1e-6).integrate(&Written(VanDerPol), &(), 0.0, 2.0, x, |step| s = step.state()[0]),
            }.unwrap();
            std::hint::black_box(s);
            best = best.min(t.elapsed().as_secs_f64());
        }
        if std::env::args().nth(2).is_none() { println!("{:.1} us, {:.0} ns/step  {:?}", best * 1e6, best * 1e9 / (stat.steps + stat.rejected) as f64, stat); break; }
    }
}
