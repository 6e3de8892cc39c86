//! Functions of the names that generated code binds. A constant of such a name, among the items of a user, would be what a
//! binding is compared with; a nearer function hides it, and bindings hide functions.

macro_rules! functions {
    ($($name:ident)*) => {
        $(
            /// Gives way to a binding.
            pub fn $name() {}
        )*
    };
}

functions! {
    ahead arguments both changing close convert derivative each entry fixed folded formatter from holds input jacobian kept memory
    model other parameters ranks rates rows slopes stages start t to u value whole x zero
}
