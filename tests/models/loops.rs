//! Nonlinear algebraic loops.

use mbg_runtime::{System, mbg};
use nalgebra::SVector;

mbg! {
    /// Source, resistor and diode in series.
    pub(crate) model Series {
        param resistance: ohm = 10.0;
        param saturation: A = 1e-12;
        param thermal: V = 0.025852;
        input voltage: V;
        1 mesh {
            Se supply { effort: voltage }
            R series { resistance: resistance }
            R diode { flow: saturation * (exp(e / thermal) - 1.0) }
        }
        integral charge = mesh.f;
        output current: A = mesh.f;
        output moved = charge;
    }
}

#[test]
fn series() {
    let model = Series::new(SeriesParameters::default()).unwrap();
    let mut memory = Default::default();
    let y = model.output(
        0.0,
        &SVector::from([0.0]),
        &SVector::from([10.0]),
        &mut memory,
    );
    println!("{y} {memory:?} {:?}", Series::<f64>::META.loops);
}
