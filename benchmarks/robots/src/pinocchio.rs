//! Robots in Pinocchio, from the library that `run` has built.

use std::error::Error;
use std::ffi::{CString, c_char, c_void};
use std::path::Path;

use libloading::{Library, Symbol};

type New = unsafe extern "C" fn(*const c_char) -> *mut c_void;
/// `acceleration(robot, position, rates, torques, result)`.
type Acceleration = unsafe extern "C" fn(*mut c_void, *const f64, *const f64, *const f64, *mut f64);

/// What is worked out.
#[derive(Clone, Copy)]
pub enum Way {
    /// Accelerations in axes of the links.
    Local,
    /// Accelerations in axes of the world.
    World,
    /// Accelerations and their derivatives by positions, rates and torques.
    Slopes,
}

pub struct Pinocchio {
    robot: *mut c_void,
    ways: [Acceleration; 3],
    result: Vec<f64>,
}

impl Pinocchio {
    /// The robot of this name, which stays until the program ends.
    pub fn new(folder: &Path, name: &str) -> Result<Self, Box<dyn Error>> {
        // SAFETY: `run` has just built this library; nothing runs when it is loaded.
        let library = unsafe { Library::new(folder.join("pinocchio.so").canonicalize()?) }?;
        let library: &'static Library = Box::leak(Box::new(library));
        let path = CString::new(
            folder
                .join(format!("{name}.joints"))
                .into_os_string()
                .into_encoded_bytes(),
        )?;
        // SAFETY: these functions of the library have these forms.
        let (robot, ways) = unsafe {
            let new: Symbol<New> = library.get("robot")?;
            let ways: [Symbol<Acceleration>; 3] = [
                library.get("local")?,
                library.get("world")?,
                library.get("slopes")?,
            ];
            (new(path.as_ptr()), ways.map(|it| *it))
        };
        Ok(Self {
            robot,
            ways,
            result: Vec::new(),
        })
    }

    /// The accelerations of all joints.
    pub fn acceleration(
        &mut self,
        way: Way,
        position: &[f64],
        rates: &[f64],
        torques: &[f64],
    ) -> &[f64] {
        self.result.resize(rates.len(), 0.0);
        let way = self.ways[way as usize];
        // SAFETY: the file of cases has as many numbers as the robot of the same name has coordinates.
        unsafe {
            way(
                self.robot,
                position.as_ptr(),
                rates.as_ptr(),
                torques.as_ptr(),
                self.result.as_mut_ptr(),
            );
        }
        &self.result
    }
}
