//! The first dimension of the UN guidance: the operational environment.

use super::{NOT_TOLD, Place, Plan, Values, crash::ROADS, words, words_or_not_told};
use recrash_model::account::{Account, RoadFeature, told};
use recrash_model::record::MPS_PER_MPH;
use recrash_model::surroundings::{Lighting, Surface, Weather};

const FEATURES: [RoadFeature; 30] = {
    use RoadFeature::{
        Alley, Bend, BikeLane, BusLane, CarpoolLane, Crosswalk, CulDeSac, DoubleYellowLine, Driveway, Garage, Gate,
        Intersection, Median, Merge, NarrowStreet, OneWay, ParkingLane, ParkingLot, Rails, Ramp, Roundabout, Shoulder,
        Sidewalk, Signal, Slope, Stall, StopSign, TurnLane, WorkZone, YieldSign,
    };
    [
        Intersection,
        Signal,
        StopSign,
        YieldSign,
        ParkingLane,
        TurnLane,
        BusLane,
        BikeLane,
        CarpoolLane,
        Driveway,
        ParkingLot,
        Garage,
        Stall,
        Crosswalk,
        Sidewalk,
        Ramp,
        Merge,
        NarrowStreet,
        OneWay,
        CulDeSac,
        Median,
        Gate,
        Alley,
        WorkZone,
        Shoulder,
        DoubleYellowLine,
        Roundabout,
        Rails,
        Bend,
        Slope,
    ]
};
const SURFACES: [Surface; 3] = [Surface::Dry, Surface::Wet, Surface::SnowIce];
const LIGHTS: [Lighting; 5] = {
    use Lighting::{DarkLighted, DarkNotLighted, DarkUnknown, DawnDusk, Daylight};
    [Daylight, DawnDusk, DarkLighted, DarkNotLighted, DarkUnknown]
};
const WEATHERS: [Weather; 7] = {
    use Weather::{Clear, Cloudy, Fog, Indoor, Rain, SevereWind, Snow};
    [Clear, Cloudy, Rain, Snow, Fog, SevereWind, Indoor]
};
/// Posted limits up to these stand in one band. [mi/h]
const BANDS_MPH: [u16; 4] = [25, 35, 45, 55];

const PLACE: &str = "place";
const FEATURE: &str = "feature";
const SURFACE: &str = "surface";
const LIGHT: &str = "light";
const WEATHER: &str = "weather";
const LIMIT: &str = "posted limit";

pub(super) fn plan() -> Plan {
    let of = |attribute: &str, values: Vec<String>| -> Vec<Values> {
        values.into_iter().map(|value| vec![attribute.to_owned(), value]).collect()
    };
    let listed = [
        of(PLACE, ROADS.iter().map(words).collect()),
        of(FEATURE, FEATURES.iter().map(words).collect()),
        of(SURFACE, SURFACES.iter().map(words).collect()),
        of(LIGHT, LIGHTS.iter().map(words).collect()),
        of(WEATHER, WEATHERS.iter().map(words).collect()),
        of(LIMIT, (0..=BANDS_MPH.len()).map(band_name).collect()),
    ];
    Plan::listing(
        ("operational-environment", "Operational environment"),
        &["attribute", "value"],
        listed.concat(),
        |account| Place::In(values(account)),
    )
    .overlapping()
}

fn values(account: &Account) -> Vec<Values> {
    let place = &account.place;
    let weather = place.weather.iter().map(|told| words(&told.value));
    let weather = if place.weather.is_empty() { vec![NOT_TOLD.to_owned()] } else { weather.collect() };
    let all = [
        (PLACE, vec![words_or_not_told(told(&place.kind))]),
        // Who tells no feature does not say that there is none.
        (FEATURE, place.features.iter().map(|told| words(&told.value)).collect()),
        (SURFACE, vec![words_or_not_told(told(&place.surface))]),
        (LIGHT, vec![words_or_not_told(told(&place.lighting))]),
        (WEATHER, weather),
        (LIMIT, vec![told(&place.posted_mps).map_or_else(|| NOT_TOLD.to_owned(), band)]),
    ];
    let pair = |(attribute, values): (&str, Vec<String>)| {
        values.into_iter().map(|value| vec![attribute.to_owned(), value]).collect::<Vec<_>>()
    };
    all.into_iter().flat_map(pair).collect()
}

fn band(limit_mps: f64) -> String {
    let limit_mph = (limit_mps / MPS_PER_MPH).round();
    band_name(BANDS_MPH.iter().position(|&end| limit_mph <= f64::from(end)).unwrap_or(BANDS_MPH.len()))
}

fn band_name(number: usize) -> String {
    match (number.checked_sub(1).map(|before| BANDS_MPH[before] + 1), BANDS_MPH.get(number)) {
        (None, Some(end)) => format!("up to {end} mph"),
        (Some(from), Some(end)) => format!("{from} to {end} mph"),
        (from, None) => format!("{} mph and more", from.unwrap_or_default()),
    }
}
