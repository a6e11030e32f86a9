//! Giving way: what is remembered of it, and what a driver sees of those he lets go first.

use crate::scene::Scene;
use recrash_plan::constants::STANDING_MPS;
use recrash_plan::{Crossing, Manners, Traveller, stop_distance};

/// What has to be remembered between decisions.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct GiveWay {
    standing_steps: u32,
}

impl GiveWay {
    /// The distance from the centre of the vehicle to where it has to wait; `None` where it may go. [m]
    pub(crate) fn stop_line(
        &mut self,
        scene: &Scene<'_>,
        me: usize,
        crossings: &[Crossing],
        wanted_mps: f64,
        manners: Manners,
    ) -> Option<f64> {
        self.count_standing(scene, me);
        self.stop_lines(scene, me, crossings, wanted_mps, manners)
            .map(|(_, distance)| distance)
            .fold(None, |nearest, distance| Some(nearest.map_or(distance, |least: f64| least.min(distance))))
    }

    /// Once per decision: how long it has been standing.
    pub(crate) fn count_standing(&mut self, scene: &Scene<'_>, me: usize) {
        let stands = scene.actors[me].speed < STANDING_MPS;
        self.standing_steps = if stands { self.standing_steps + 1 } else { 0 };
    }

    /// Every crossing it has to wait at now, with the distance from its centre to the place to wait. [m]
    pub(crate) fn stop_lines<'a>(
        &'a self,
        scene: &'a Scene<'_>,
        me: usize,
        crossings: &'a [Crossing],
        wanted_mps: f64,
        manners: Manners,
    ) -> impl Iterator<Item = (&'a Crossing, f64)> + 'a {
        let traveller = |actor: usize| Traveller { s_m: scene.path_s(actor), speed_mps: scene.actors[actor].speed };
        let mine = traveller(me);
        let there = move |crossing: &&Crossing| crossing.me == me && scene.actors[crossing.other].present;
        crossings.iter().filter(there).filter_map(move |crossing| {
            let other = traveller(crossing.other);
            let distance = stop_distance(crossing, mine, other, self.standing_steps, wanted_mps, manners)?;
            Some((crossing, distance))
        })
    }
}
