mod models;
use mbg_runtime::System;
fn main() {
    println!("{:#?}", <models::Ins as System<f64, 9, 3, 3>>::META.operations);
    println!("{:#?}", <models::InsClassic as System<f64, 9, 3, 3>>::META.operations);
    println!("{:?}", <models::Ins as System<f64, 9, 3, 3>>::META.conditioning);
    println!("{:?}", <models::InsClassic as System<f64, 9, 3, 3>>::META.conditioning);
}
