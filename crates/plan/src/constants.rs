//! Every number that gives plans their meaning, with unit, reason and source; MetaDrive's Python gets them as data.

use recrash_model::rollout::STEP_S;
use serde::Serialize;

/// Below this speed a road user stands. Bullet's vehicles jitter by up to 0.24 m/s with the brake held. [m/s]
pub const STANDING_MPS: f64 = 0.3;

/// Above this speed a brake to a stand is full, below it light. [m/s]
pub const HOLD_BELOW_MPS: f64 = 0.5;

/// The light brake that holds a vehicle; under a full one MetaDrive's vehicles creep backwards (measured). [-1 to 1]
pub const HOLD_BRAKE: f64 = -0.1;

/// The least throttle of somebody who does not brake: at exactly none the rolling resistance of both simulators acts,
/// and whether a speed is met to the last bit would decide on it. [-1 to 1]
pub const LEAST_THROTTLE: f64 = 1e-6;

/// Deceleration with which a partner comes down to a speed: what drivers of the intelligent driver model find
/// comfortable (treiber2013, 2 m/s^2). [m/s^2]
pub const COMFORTABLE_MPS2: f64 = 2.0;

/// Deceleration with which a partner stops at a place that it sees in time: a firm stop, below the 3.4 m/s^2 that
/// aashto2018 calls comfortable for most drivers. [m/s^2]
pub const STOPPING_MPS2: f64 = 3.0;

/// The most it brakes where it sees that place late: most drivers brake with more than 4.5 m/s^2 when surprised
/// (aashto2018), few with more than this; assumed. [m/s^2]
pub const GREATEST_BRAKING_MPS2: f64 = 6.0;

/// No kind plans with more than this share of the deceleration it can reach.
pub const SHARE_OF_BRAKES: f64 = 0.6;

/// Time in which a partner makes up for what it is too fast on its way to a bend or a stop; assumed. [s]
pub const CATCH_UP_S: f64 = 0.5;

/// It stops with its front this far before the place; assumed. [m]
pub const STOP_SHORT_M: f64 = 0.5;

/// An obstacle that it would brush by no more than this is not on its line: less than it sways. [m]
pub const BRUSHES_M: f64 = 0.1;

/// Bends are driven at this share of the sideways acceleration a kind may have, so that there is some left to steer with.
pub const SHARE_IN_BENDS: f64 = 0.8;

/// The wanted line may run at no more than this angle to the lane, for vehicles; assumed. [rad]
pub const GREATEST_DRIFT_RAD: f64 = 0.5;

/// The same for who walks, or steps on and off what it rides: almost straight across. [rad]
pub const GREATEST_DRIFT_ON_FOOT_RAD: f64 = 1.3;

/// A speed low enough to divide a sideways rate by. [m/s]
pub const SLOW_MPS: f64 = 1.0;

/// The shortest time a sideways move is divided by. [s]
pub const SHORTEST_MOVE_S: f64 = 1e-3;

/// The lane keeper looks this far ahead in time: the lag of held controls, wheels and published places together,
/// 0.05 + 0.1 + 0.02 s (`docs/models/vehicle.md`). [s]
pub const PREVIEW_S: f64 = 0.17;

/// Places are seen this late: one physics step (`docs/models/vehicle.md`). So what is previewed is that much nearer in
/// time. [s]
pub const SEEN_LATE_S: f64 = 0.02;

/// The time in which a deviation from the line goes down to 1/e, twice: both poles lie there (critical damping), far
/// enough from the lag above; assumed. [s]
pub const RETURN_S: f64 = 0.6;

/// The way in which it does so is never shorter than this many wheelbases.
pub const RETURN_WHEELBASES: f64 = 0.6;

/// A place to wait at that lies this far behind the vehicle's centre has been passed: it goes on. [m]
pub const COMMITTED_M: f64 = 1.0;

/// After standing this long where the other stands too, the one who came later goes as well; assumed. [steps]
pub const PATIENCE_STEPS: u32 = 30;

/// Nobody further away than this is thought about; assumed. [s]
pub const HORIZON_S: f64 = 12.0;

/// Where paths merge, the other has gone first when it is this far along the common lane; assumed. [m]
pub const MERGED_M: f64 = 12.0;

/// Who merges is behind the place of the conflict after this time; assumed. [s]
pub const MERGING_S: f64 = 1.0;

/// Others may speed up; going first allows for this; assumed. [m/s^2]
pub const THEIR_ACCELERATION_MPS2: f64 = 1.0;

/// MetaDrive's gap law (`IDMPolicy`): distance wanted behind somebody who stands (`DISTANCE_WANTED`). [m]
pub const STANDSTILL_DISTANCE_M: f64 = 10.0;

/// Its time headway (`TIME_WANTED`), but multiplied with km/h: in effect 5.4 s. [s]
pub const TIME_HEADWAY_S: f64 = 1.5;

/// Its acceleration and comfortable deceleration (`ACC_FACTOR`, `DEACC_FACTOR`), as shares of full throttle.
pub const ACCELERATION: f64 = 1.0;
/// See [`ACCELERATION`].
pub const DECELERATION: f64 = 5.0;

/// It sees nothing farther ahead or behind than this (`MAX_LONG_DIST`). [m]
pub const SIGHT_M: f64 = 30.0;

/// The ego has stood this long, and nobody else moves: it is stuck; assumed. [steps]
pub const STUCK_STEPS: u32 = 200;

/// MetaDrive draws the overtaking timer of a vehicle from 0..50 at its start; the ego takes the middle, so that a rollout
/// depends on nothing but its scenario (background traffic has its own, `roads::background_traffic`). [steps]
pub const EGO_OVERTAKE_TIMER_STEPS: u32 = 25;

/// Deceleration with which a built-in ego stops for what it sees in time (treiber2013). [m/s^2]
pub const HALT_MPS2: f64 = 2.0;

/// Deceleration above which it goes on when a signal turns yellow: 10 ft/s^2, by which yellow times are set (ite2020). [m/s^2]
pub const YELLOW_MPS2: f64 = 3.05;

/// It stands this far before the place, at most. [m]
pub const HALT_SHORT_M: f64 = 0.3;

/// A place farther behind than this has been passed. [m]
pub const PASSED_LINE_M: f64 = 1.5;

/// Height of the centre of mass of a vehicle whose four springs carry it, by the springs of `docs/models/vehicle.md`. [m]
pub const SETTLED_HEIGHT_M: f64 = 0.6 - 9.81 / (4.0 * 40.0);

/// Time for which it stands at a stop sign; assumed. [steps]
pub const SIGN_STEPS: u32 = 10;

/// It pulls over, and out again, within these distances of its stop. [m]
pub const PULL_OVER_M: f64 = 30.0;
/// See [`PULL_OVER_M`]. [m]
pub const STRAIGHT_BEFORE_M: f64 = 4.0;

/// All of them as data. Units as above.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(missing_docs, reason = "each is the constant of its name")]
pub struct Constants {
    pub step_s: f64,
    pub standing_mps: f64,
    pub hold_below_mps: f64,
    pub hold_brake: f64,
    pub least_throttle: f64,
    pub catch_up_s: f64,
    pub stop_short_m: f64,
    pub slow_mps: f64,
    pub shortest_move_s: f64,
    pub brushes_m: f64,
    pub preview_s: f64,
    pub seen_late_s: f64,
    pub return_s: f64,
    pub return_wheelbases: f64,
    pub committed_m: f64,
    pub patience_steps: u32,
    pub horizon_s: f64,
    pub merged_m: f64,
    pub merging_s: f64,
    pub their_acceleration_mps2: f64,
    pub stuck_steps: u32,
    pub halt_mps2: f64,
    pub yellow_mps2: f64,
    pub halt_short_m: f64,
    pub passed_line_m: f64,
    pub sign_steps: u32,
    pub pull_over_m: f64,
    pub straight_before_m: f64,
    pub settled_height_m: f64,
}

impl Constants {
    /// Those of this build.
    pub const ALL: Self = Self {
        step_s: STEP_S,
        standing_mps: STANDING_MPS,
        hold_below_mps: HOLD_BELOW_MPS,
        hold_brake: HOLD_BRAKE,
        least_throttle: LEAST_THROTTLE,
        catch_up_s: CATCH_UP_S,
        stop_short_m: STOP_SHORT_M,
        slow_mps: SLOW_MPS,
        shortest_move_s: SHORTEST_MOVE_S,
        brushes_m: BRUSHES_M,
        preview_s: PREVIEW_S,
        seen_late_s: SEEN_LATE_S,
        return_s: RETURN_S,
        return_wheelbases: RETURN_WHEELBASES,
        committed_m: COMMITTED_M,
        patience_steps: PATIENCE_STEPS,
        horizon_s: HORIZON_S,
        merged_m: MERGED_M,
        merging_s: MERGING_S,
        their_acceleration_mps2: THEIR_ACCELERATION_MPS2,
        stuck_steps: STUCK_STEPS,
        halt_mps2: HALT_MPS2,
        yellow_mps2: YELLOW_MPS2,
        halt_short_m: HALT_SHORT_M,
        passed_line_m: PASSED_LINE_M,
        sign_steps: SIGN_STEPS,
        pull_over_m: PULL_OVER_M,
        straight_before_m: STRAIGHT_BEFORE_M,
        settled_height_m: SETTLED_HEIGHT_M,
    };
}
