//! Thresholds of the laws at which a motion may stay.

use super::over::Place;
use super::problem::Problem;
use super::sliding::Rooms;
use super::thresholds::Point;
use crate::lane::{are_alike, lane};
use crate::{Course, Input, Real, System};

/// A state is at a threshold that it comes to within so many units of the last place of the time.
const PLACES: f64 = 64.0;

/// A threshold of an argument of choices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Surface<T> {
    /// The number of the argument, as [`System::courses`] tells of it.
    pub(super) course: usize,
    /// What the argument is there.
    pub(super) level: T,
}

/// The place of the one of this argument.
fn of<T: Copy>(surfaces: &[Surface<T>], course: usize) -> Option<(usize, T)> {
    let mut surfaces = surfaces.iter().enumerate();
    surfaces.find_map(|(place, it)| (it.course == course).then_some((place, it.level)))
}

/// [`Surfaces`], whatever room they have.
pub(super) trait AnySurfaces<T>: Copy {
    fn none() -> Self;

    /// Adds one, unless its argument is at one or there is no room.
    fn add(&mut self, surface: Surface<T>);

    fn as_slice(&self) -> &[Surface<T>];
}

/// Those for which a system has room.
pub(super) type SurfacesOf<T, S, const N: usize, const M: usize, const P: usize> =
    <<S as System<T, N, M, P>>::Room as Rooms>::Surfaces<T>;

/// Thresholds at which a motion stays, each of an argument of its own, with room for so many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surfaces<T, const K: usize> {
    count: usize,
    all: [Surface<T>; K],
}

impl<T: Real, const K: usize> AnySurfaces<T> for Surfaces<T, K> {
    fn none() -> Self {
        let (course, level) = (0, T::from_f64(0.0));
        let all = [Surface { course, level }; K];
        Self { count: 0, all }
    }

    fn add(&mut self, surface: Surface<T>) {
        if self.of(surface.course).is_none()
            && let Some(free) = self.all.get_mut(self.count)
        {
            *free = surface;
            self.count += 1;
        }
    }

    fn as_slice(&self) -> &[Surface<T>] {
        self.all.get(..self.count).unwrap_or_default()
    }
}

impl<T: Real, const K: usize> Surfaces<T, K> {
    pub(super) fn one(surface: Surface<T>) -> Self {
        let mut one = Self::none();
        one.add(surface);
        one
    }

    pub(super) const fn count(&self) -> usize {
        self.count
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Surface<T>> {
        self.as_slice().iter().copied()
    }

    /// The place of the one of this argument.
    pub(super) fn of(&self, course: usize) -> Option<(usize, T)> {
        of(self.as_slice(), course)
    }

    /// These and others.
    pub(super) fn with(mut self, others: &[Surface<T>]) -> Self {
        others.iter().for_each(|other| self.add(*other));
        self
    }

    /// These without others.
    pub(super) fn without(&self, others: &[Surface<T>]) -> Self {
        let mut without = Self::none();
        let left = self.iter().filter(|it| of(others, it.course).is_none());
        left.for_each(|it| without.add(it));
        without
    }
}

impl<T, S, I, const N: usize, const M: usize, const P: usize> Problem<'_, T, S, I, N, M, P>
where
    T: Real,
    S: System<T, N, M, P>,
    I: Input<T, M> + ?Sized,
{
    /// The thresholds between two points next to each other.
    pub(super) fn between(
        &self,
        from: &Point<T, N>,
        to: &Point<T, N>,
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        self.surfaces(from, to, is_between)
    }

    /// The same but for those from which the motion goes on behind them.
    pub(super) fn met_between(
        &self,
        from: &Point<T, N>,
        to: &Point<T, N>,
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        self.surfaces(from, to, |course, level| {
            let goes_on = are_alike(lane(course.to[0] - course.from[0]), lane(course.to[1]));
            is_between(course, level) && !goes_on
        })
    }

    /// The thresholds next to a place where a run begins.
    pub(super) fn at_start(&mut self, place: Place<T, N>) -> Option<SurfacesOf<T, S, N, M, P>> {
        let memory = self.memory;
        let here = self.point(place);
        self.memory = memory;
        self.next_to(&here)
    }

    /// Some thresholds and those next to such a place.
    pub(super) fn also_at_start(
        &mut self,
        place: Place<T, N>,
        mut surfaces: SurfacesOf<T, S, N, M, P>,
    ) -> SurfacesOf<T, S, N, M, P> {
        let others = self.at_start(place);
        let others = others.iter().flat_map(AnySurfaces::as_slice);
        others.for_each(|other| surfaces.add(*other));
        surfaces
    }

    /// A place with the derivative there.
    pub(super) fn point(&mut self, (time, state): Place<T, N>) -> Point<T, N> {
        let slope = self.slope(time, &state);
        Point { time, state, slope }
    }

    /// The thresholds next to a point.
    pub(super) fn next_to(&self, here: &Point<T, N>) -> Option<SurfacesOf<T, S, N, M, P>> {
        let [unit, whole] = [PLACES * T::EPSILON, self.whole].map(T::Lane::from_f64);
        let time = unit * lane(here.time).abs().max(whole);
        self.surfaces(here, here, |course, level| {
            let [value, rate] = course.from.map(lane);
            (value - lane(level)).abs() <= time * rate.abs()
        })
    }

    /// The thresholds that a motion comes to within a time, as fast as it is, or at which it is.
    pub(super) fn ahead(
        &self,
        here: &Point<T, N>,
        lasting: f64,
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        let [zero, lasting] = [0.0, lasting].map(T::Lane::from_f64);
        self.surfaces(here, here, |course, level| {
            let [value, rate] = course.from.map(lane);
            let way = lane(level) - value;
            way == zero || (are_alike(way, rate) && way.abs() <= lasting * rate.abs())
        })
    }

    /// The thresholds of which this holds, unless several lanes have a time.
    fn surfaces(
        &self,
        from: &Point<T, N>,
        to: &Point<T, N>,
        holds: impl Fn(&Course<'_, T>, T) -> bool,
    ) -> Option<SurfacesOf<T, S, N, M, P>> {
        if from.time.in_lane(1).is_some() {
            return None;
        }
        let mut surfaces = None;
        let mut number = 0;
        self.courses(from, to, |course, _| {
            for threshold in course.thresholds {
                let level = course.level(*threshold);
                if course.is_choice && holds(course, level) {
                    let surfaces = surfaces.get_or_insert_with(SurfacesOf::<T, S, N, M, P>::none);
                    surfaces.add(Surface {
                        course: number,
                        level,
                    });
                }
            }
            number += 1;
        });
        surfaces
    }
}

/// Whether a time is later than another one by more than numbers may blur.
pub(super) fn is_later<T: Real>(time: T, later: T) -> bool {
    lane(later - time) > T::Lane::from_f64(PLACES * T::EPSILON) * lane(later).abs()
}

pub(super) fn is_between<T: Real>(course: &Course<'_, T>, level: T) -> bool {
    let [from, to] = [course.from, course.to].map(|it| lane(it[0] - level));
    let zero = T::Lane::from_f64(0.0);
    let is_passed = (from <= zero && to >= zero) || (from >= zero && to <= zero);
    is_passed && from != to
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_keep_their_order() {
        let surface = |course| Surface {
            course,
            level: course as f64,
        };
        let of = |courses: &[usize]| {
            let mut surfaces = Surfaces::<_, 8>::none();
            courses
                .iter()
                .for_each(|course| surfaces.add(surface(*course)));
            surfaces
        };
        let surfaces = of(&[4, 2, 4, 7]);
        assert_eq!(surfaces.count(), 3);
        assert_eq!(surfaces.of(7), Some((2, 7.0)));
        assert_eq!(surfaces.without(of(&[2, 5]).as_slice()), of(&[4, 7]));
        let many: [usize; 8] = core::array::from_fn(|number| 10 + number);
        let all = surfaces.with(of(&many).as_slice());
        assert_eq!(all.count(), 8);
        assert_eq!(all.of(10), Some((3, 10.0)));
    }
}
