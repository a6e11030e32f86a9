//! Weather, light and friction.

use crate::openscenario::entities::property;
use crate::xml::{Element, number};
use recrash_model::scenario::Environment;
use recrash_model::surroundings::{Lighting, Surface, Weather};

/// The environment action.
pub(super) fn environment_action(environment: &Environment) -> Element {
    let road = Element::new("RoadCondition")
        .with("frictionScaleFactor", number(environment.surface.relative_friction()))
        .with("wetness", wetness(environment));
    Element::new("GlobalAction").child(
        Element::new("EnvironmentAction").child(
            Element::new("Environment").with("name", "environment").children([
                Element::new("TimeOfDay")
                    .with("animation", "false")
                    .with("dateTime", format!("2024-06-21T{}", time_of_day(environment.lighting))),
                weather(environment),
                match lamps(environment.lighting) {
                    None => road,
                    Some(lamps) => road.child(Element::new("Properties").child(property("streetLamps", lamps))),
                },
            ]),
        ),
    )
}

fn wetness(environment: &Environment) -> &'static str {
    match environment.surface {
        Surface::Dry => "dry",
        Surface::Wet => "wetWithPuddles",
        Surface::SnowIce => "moist",
    }
}

/// Mid-summer in local time: light at noon, twilight at dusk, dark at midnight. Assumed.
fn time_of_day(lighting: Lighting) -> &'static str {
    match lighting {
        Lighting::Daylight => "12:00:00",
        Lighting::DawnDusk => "21:15:00",
        Lighting::DarkLighted | Lighting::DarkNotLighted | Lighting::DarkUnknown => "00:00:00",
    }
}

fn lamps(lighting: Lighting) -> Option<&'static str> {
    match lighting {
        Lighting::DarkLighted => Some("on"),
        Lighting::DarkNotLighted => Some("off"),
        Lighting::Daylight | Lighting::DawnDusk | Lighting::DarkUnknown => None,
    }
}

/// Rates of moderate rain and snow, and the sight in fog, are textbook values (WMO: moderate rain 2.5 to 10 mm/h, fog
/// below 1000 m). Assumed for the crash.
fn weather(environment: &Environment) -> Element {
    let (clouds, kind, rate, sight) = match environment.weather {
        Weather::Clear | Weather::Indoor => ("zeroOktas", "dry", 0.0, 100_000.0),
        Weather::Cloudy => ("sixOktas", "dry", 0.0, 20_000.0),
        Weather::Rain => ("eightOktas", "rain", 5.0, 5000.0),
        Weather::Snow => ("eightOktas", "snow", 2.0, 2000.0),
        Weather::Fog => ("eightOktas", "dry", 0.0, 200.0),
        Weather::SevereWind => ("sixOktas", "dry", 0.0, 5000.0),
    };
    // Angles of the sun at noon, at dusk and at midnight. [rad]; light on the ground. [lx]
    let (elevation, lux) = match environment.lighting {
        Lighting::Daylight if environment.weather == Weather::Clear => (1.0, 80_000.0),
        Lighting::Daylight => (1.0, 10_000.0),
        Lighting::DawnDusk => (-0.05, 100.0),
        Lighting::DarkLighted | Lighting::DarkNotLighted | Lighting::DarkUnknown => (-0.7, 0.1),
    };
    let wind = if environment.weather == Weather::SevereWind { 20.0 } else { 0.0 };
    Element::new("Weather").with("fractionalCloudCover", clouds).children([
        Element::new("Sun").with("azimuth", "0").with_number("elevation", elevation).with_number("illuminance", lux),
        Element::new("Fog").with_number("visualRange", sight),
        Element::new("Precipitation").with("precipitationType", kind).with_number("precipitationIntensity", rate),
        Element::new("Wind").with("direction", "0").with_number("speed", wind),
    ])
}
