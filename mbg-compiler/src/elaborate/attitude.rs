//! Attitudes: states that are a quaternion or a rotation matrix, and that stay one.

use std::ops::Range;

use syn::spanned::Spanned;
use syn::{Expr, ExprPath};

use super::Builder;
use super::claims::Subject;
use super::definitions::{Definition, Progress};
use super::expressions::{Result, Value};
use super::laws::check_symmetry;
use super::model::{Attitude, StateRate};
use super::orientation::rotation;
use super::scope::Entity;
use crate::codes;
use crate::diagnostics::error;
use crate::symbolic::field::Image;
use crate::symbolic::{Expression, Function, Matrix, Symbol};
use crate::syntax::ast::{self, Orientation};
use crate::syntax::dump;

impl Builder<'_> {
    /// Puts the states of an attitude where they are a rotation exactly, and says what their name stands for.
    pub(super) fn place_attitude(&mut self, form: Orientation, states: Range<usize>) -> Entity {
        let (first, word) = (states.start, states.start as u64);
        let (columns, images) = match form {
            Orientation::Quaternion => (4, Image::sphere(word).to_vec()),
            Orientation::Matrix => (3, Image::rotation(word).to_vec()),
        };
        for (state, image) in states.clone().zip(images) {
            self.pool.locate(state, image);
        }
        let row = |start: usize| (start..start + columns).collect();
        self.attitudes.push(Attitude {
            rows: states.clone().step_by(columns).map(row).collect(),
        });
        match form {
            Orientation::Quaternion => Entity::States(first..states.end),
            Orientation::Matrix => Entity::Rotation(states),
        }
    }

    /// `q̇ = ½ q∘(0, ω)`, or `Ṙ = R skew(ω)`.
    pub(super) fn attitude(
        &mut self,
        scope: usize,
        attitude: &ast::Attitude,
        states: Range<usize>,
    ) -> Result<()> {
        let what = "an angular velocity has three components";
        let omega = self.components(scope, &attitude.angular_velocity, 3, what)?;
        let span = attitude.angular_velocity.span();
        self.claim(scope, Subject::Turning, &omega, span);
        let own: Vec<Expression> = states
            .clone()
            .map(|state| self.pool.symbol(Symbol::State(state)))
            .collect();
        let (rates, initial) = match attitude.orientation {
            Orientation::Quaternion => (
                self.quaternion_rates(&own, &omega),
                self.initial_quaternion(scope, attitude)?,
            ),
            Orientation::Matrix => (
                self.matrix_rates(&own, &omega),
                self.initial_matrix(scope, attitude)?,
            ),
        };
        let place = attitude.initial.as_ref();
        let place = place.map_or(attitude.name.span(), |value| value.span());
        for ((state, rate), initial) in states.zip(rates).zip(initial) {
            self.states[state].rate = StateRate::Expression(rate);
            self.initial_value(state, initial, place)?;
        }
        Ok(())
    }

    /// Reports springs of quaternions and rotation matrices that would create energy, as those of other joints are.
    pub(super) fn check_springs(&mut self) {
        let rotations = self.called.iter();
        let rotations = rotations.filter(|(inner, (_, instance))| {
            let inside = &self.scopes[**inner];
            let is_free = inside.library.is_some() && instance.component == "FreeRotation";
            // The springs of angles are storages, which are checked where they are read.
            is_free && !inside.names.contains_key("gimbal")
        });
        let scopes: Vec<usize> = rotations.map(|(inner, _)| *inner).collect();
        for scope in scopes {
            let Some(Entity::Definition(id)) = self.scopes[scope].names.get("stiffness") else {
                continue;
            };
            let Definition { name, progress, .. } = &self.definitions[*id];
            let name = *name;
            let Progress::Known(Value::Matrix(stiffness)) = progress else {
                continue;
            };
            // Another shape is told where the spring reads it.
            if stiffness.rows() != stiffness.columns() {
                continue;
            }
            let stiffness = stiffness.to_matrix(self.pool);
            if let Err(report) = check_symmetry(self.pool, &stiffness, name.span()) {
                let read = Expr::Path(ExprPath {
                    attrs: Vec::new(),
                    qself: None,
                    path: name.clone().into(),
                });
                self.tell_of(scope, *report, &[&read]);
            }
        }
    }

    /// The components of a value of which it is known how many it has.
    fn components(
        &mut self,
        scope: usize,
        expression: &Expr,
        count: usize,
        what: &str,
    ) -> Result<Vec<Expression>> {
        let value = self.evaluate(scope, expression)?;
        let entries = value.entries(self.pool).unwrap_or_default();
        if entries.len() == count {
            return Ok(entries);
        }
        let message = format!("{what}, found {}", value.shape());
        let report = error(codes::WRONG_DIMENSION, expression.span(), message);
        let frame = count == 3 && entries.len() == 6;
        Err(Box::new(if frame && matches!(expression, Expr::Field(_)) {
            let text = dump::expression(expression);
            report.help(format!("write `{text}[0..3]` for that of a frame"))
        } else {
            report
        }))
    }

    fn quaternion_rates(&mut self, q: &[Expression], omega: &[Expression]) -> Vec<Expression> {
        let pool = &mut *self.pool;
        let two = pool.integer(2);
        let half: Vec<Expression> = omega
            .iter()
            .map(|rate| pool.divide(*rate, two).unwrap_or(Expression::ZERO))
            .collect();
        let rows = [
            [(1, 0, true), (2, 1, true), (3, 2, true)],
            [(0, 0, false), (2, 2, false), (3, 1, true)],
            [(0, 1, false), (3, 0, false), (1, 2, true)],
            [(0, 2, false), (1, 1, false), (2, 0, true)],
        ];
        let rate = |row: [(usize, usize, bool); 3]| {
            let terms =
                row.map(|(part, axis, minus)| pool.multiply(q[part], half[axis]).flipped(minus));
            pool.sum(&terms)
        };
        rows.map(rate).to_vec()
    }

    /// Each row turns by itself: its rate is `row × ω`.
    fn matrix_rates(&mut self, matrix: &[Expression], omega: &[Expression]) -> Vec<Expression> {
        let rate = |entry: usize| {
            let (row, column) = (entry / 3, entry % 3);
            let (next, last) = ((column + 1) % 3, (column + 2) % 3);
            let plus = self.pool.multiply(matrix[3 * row + next], omega[last]);
            let minus = self.pool.multiply(matrix[3 * row + last], omega[next]);
            self.pool.subtract(plus, minus)
        };
        (0..9).map(rate).collect()
    }

    /// Divided by its length.
    fn initial_quaternion(
        &mut self,
        scope: usize,
        attitude: &ast::Attitude,
    ) -> Result<Vec<Expression>> {
        let Some(value) = &attitude.initial else {
            let mut none = vec![Expression::ZERO; 4];
            none[0] = Expression::ONE;
            return Ok(none);
        };
        let parts = self.components(scope, value, 4, "a quaternion has four components")?;
        let squares: Vec<Expression> = parts
            .iter()
            .map(|part| self.pool.multiply(*part, *part))
            .collect();
        let square = self.pool.sum(&squares);
        if square == Expression::ONE {
            return Ok(parts);
        }
        let length = self.pool.call(Function::Sqrt, &[square]);
        let divided = parts.iter().map(|part| self.pool.divide(*part, length));
        let divided: Option<Vec<Expression>> = divided.collect();
        divided.ok_or_else(|| {
            let message = "a quaternion of zeros is no rotation";
            let report = error(codes::NO_ROTATION, self.place(scope, value.span()), message);
            Box::new(report.help("write `initial: [1.0, 0.0, 0.0, 0.0]` for none"))
        })
    }

    /// By rows. Constants must be those of a rotation.
    fn initial_matrix(
        &mut self,
        scope: usize,
        attitude: &ast::Attitude,
    ) -> Result<Vec<Expression>> {
        let value = match &attitude.initial {
            Some(value) => value,
            None => return Ok(Matrix::diagonal(&[Expression::ONE; 3]).entries),
        };
        let span = self.place(scope, value.span());
        let value = self.evaluate(scope, value)?;
        Ok(rotation(self.pool, value, span)?.entries)
    }
}
