//! The columns of the three editions of the SGO file, and how a header is recognised.

use crate::text::header_key;
use recrash_model::record::Edition;
use recrash_model::surroundings::Weather;
use recrash_model::zones::ContactZone;
use std::collections::BTreeSet;

/// The 122 columns of the first edition (June 2021 to mid 2023).
const FIRST_HEADER: &str = "\
    Report ID,Report Version,Reporting Entity,Report Type,Report Month,Report Year,Report Submission Date,VIN,\
    VIN - Unknown,Serial Number,Make,Model,Model - Unknown,Model Year,Model Year - Unknown,Same Vehicle ID,Mileage,\
    Mileage - Unknown,Driver / Operator Type,ADAS/ADS Version,ADAS/ADS Version - Unknown,ADAS/ADS Version CBI,\
    ADS Equipped?,Automation System Engaged?,Operating Entity,Operating Entity - Unknown,Source - Complaint/Claim,\
    Source - Telematics,Source - Law Enforcement,Source - Field Report,Source - Testing,Source - Media,\
    Source - Other,Source - Other Text,Incident Date,Incident Date - Unknown,Notice Received Date,\
    Incident Time (24:00),Incident Time - Unknown,Same Incident ID,Latitude,Latitude  - Unknown,Longitude,\
    Longitude - Unknown,Address,Address - Unknown,City,City - Unknown,State,Zip Code,Zip Code - Unknown,\
    Roadway Type,Roadway Surface,Roadway Description,Posted Speed Limit (MPH),Posted Speed Limit - Unknown,Lighting,\
    Weather - Clear,Weather - Snow,Weather - Cloudy,Weather - Fog/Smoke,Weather - Rain,Weather - Severe Wind,\
    Weather - Unknown,Weather - Other,Weather - Other Text,Crash With,Highest Injury Severity,Property Damage?,\
    CP Pre-Crash Movement,CP Any Air Bags Deployed?,CP Was Vehicle Towed?,CP Contact Area - Rear Left,\
    CP Contact Area - Left,CP Contact Area - Front Left,CP Contact Area - Rear,CP Contact Area - Top,\
    CP Contact Area - Front,CP Contact Area - Rear Right,CP Contact Area - Right,CP Contact Area - Front Right,\
    CP Contact Area - Bottom,CP Contact Area - Unknown,SV Pre-Crash Movement,SV Any Air Bags Deployed?,\
    SV Was Vehicle Towed?,SV Were All Passengers Belted?,SV Precrash Speed (MPH),SV Pre-crash Speed - Unknown,\
    SV Contact Area - Rear Left,SV Contact Area - Left,SV Contact Area - Front Left,SV Contact Area - Rear,\
    SV Contact Area - Top,SV Contact Area - Front,SV Contact Area - Rear Right,SV Contact Area - Right,\
    SV Contact Area - Front Right,SV Contact Area - Bottom,SV Contact Area - Unknown,Data Availability - EDR,\
    Data Availability - Police Rpt,Data Availability - Telematics,Data Availability - Complaints,\
    Data Availability - Video,Data Availability - Other,Data Availability - No Data,Data Availability - Unknown,\
    Law Enforcement Investigating?,Investigating Agency,Investigating Agency - Unknown,\
    Rep Ent Or Mfr Investigating?,Investigating Officer Name,Inv. Officer Name - Unknown,\
    Investigating Officer Phone,Inv. Officer Phone - Unknown,Investigating Officer Email,\
    Inv. Officer Email - Unknown,Within ODD?,Within ODD? - CBI,Narrative,Narrative - CBI?";

/// The 137 columns of the second edition (to June 2025).
const SECOND_HEADER: &str = "\
    Report ID,Report Version,Reporting Entity,Report Type,Report Month,Report Year,Report Submission Date,VIN,\
    VIN - Unknown,Serial Number,Make,Model,Model - Unknown,Model Year,Model Year - Unknown,Same Vehicle ID,Mileage,\
    Mileage - Unknown,Driver / Operator Type,ADAS/ADS System Version,ADAS/ADS System Version - Unk,\
    ADAS/ADS System Version CBI,ADAS/ADS Hardware Version,ADAS/ADS Hardware Version - Unk,\
    ADAS/ADS Hardware Version CBI,ADAS/ADS Software Version,ADAS/ADS Software Version - Unk,\
    ADAS/ADS Software Version CBI,Other Reporting Entities?,Other Reporting Entities? - Unk,\
    Other Reporting Entities? - NA,Federal Regulatory Exemption?,Other Federal Reg. Exemption,\
    Federal Reg. Exemption - Unk,Federal Reg. Exemption - No,State or Local Permit?,State or Local Permit,\
    ADS Equipped?,Automation System Engaged?,Operating Entity,Operating Entity - Unknown,Source - Complaint/Claim,\
    Source - Telematics,Source - Law Enforcement,Source - Field Report,Source - Testing,Source - Media,\
    Source - Other,Source - Other Text,Incident Date,Incident Date - Unknown,Notice Received Date,\
    Incident Time (24:00),Incident Time - Unknown,Same Incident ID,Latitude,Latitude - Unknown,Longitude,\
    Longitude - Unknown,Address,Address - Unknown,City,City - Unknown,State,Zip Code,Zip Code - Unknown,\
    Roadway Type,Roadway Surface,Roadway Description,Posted Speed Limit (MPH),Posted Speed Limit - Unknown,Lighting,\
    Weather - Clear,Weather - Snow,Weather - Cloudy,Weather - Fog/Smoke,Weather - Rain,Weather - Severe Wind,\
    Weather - Unknown,Weather - Other,Weather - Other Text,Crash With,Highest Injury Severity Alleged,\
    Property Damage?,CP Pre-Crash Movement,CP Any Air Bags Deployed?,CP Was Vehicle Towed?,\
    CP Contact Area - Rear Left,CP Contact Area - Left,CP Contact Area - Front Left,CP Contact Area - Rear,\
    CP Contact Area - Top,CP Contact Area - Front,CP Contact Area - Rear Right,CP Contact Area - Right,\
    CP Contact Area - Front Right,CP Contact Area - Bottom,CP Contact Area - Unknown,SV Pre-Crash Movement,\
    SV Any Air Bags Deployed?,SV Was Vehicle Towed?,SV Were All Passengers Belted?,SV Precrash Speed (MPH),\
    SV Pre-crash Speed - Unknown,SV Contact Area - Rear Left,SV Contact Area - Left,SV Contact Area - Front Left,\
    SV Contact Area - Rear,SV Contact Area - Top,SV Contact Area - Front,SV Contact Area - Rear Right,\
    SV Contact Area - Right,SV Contact Area - Front Right,SV Contact Area - Bottom,SV Contact Area - Unknown,\
    Data Availability - EDR,Data Availability - Police Rpt,Data Availability - Telematics,\
    Data Availability - Complaints,Data Availability - Video,Data Availability - Other,Data Availability - No Data,\
    Data Availability - Unknown,Law Enforcement Investigating?,Investigating Agency,Investigating Agency - Unknown,\
    Rep Ent Or Mfr Investigating?,Investigating Officer Name,Inv. Officer Name - Unknown,\
    Investigating Officer Phone,Inv. Officer Phone - Unknown,Investigating Officer Email,\
    Inv. Officer Email - Unknown,Within ODD?,Within ODD? - CBI,Narrative,Narrative - CBI?";

/// The 116 columns of the third edition (since the third amendment of June 2025).
const THIRD_HEADER: &str = "\
    Report ID,Report Version,Reporting Entity,Report Type,Report Month,Report Year,Report Submission Date,VIN,\
    VIN Decoded,Serial Number,Make,Make - Unknown,Model,Model - Unknown,Model Year,Model Year - Unknown,\
    Same Vehicle ID,Driver / Operator Type,Automation Feature Version,Automation Feature Version CBI,\
    Automation System Engaged?,Engagement Status,Operating Entity,Operating Entity - Unknown,\
    Source - Complaint/Claim,Source - Telematics,Source - Law Enforcement,Source - Field Report,Source - Testing,\
    Source - Media,Source - Internal Process Review,Source - NHTSA VOQ,Source - Other - See Narrative,\
    Source - Other Entity,Source - State or Other Agency,Incident Date,Incident Date - Unknown,\
    Incident Time (24:00),Incident Time - Unknown,Same Incident ID,Latitude,Latitude - Unknown,Longitude,\
    Longitude - Unknown,Address,Address - Unknown,City,City - Unknown,State,Zip Code,Zip Code - Unknown,\
    Roadway Type,Roadway-Degraded Surface,Roadway-Missing/Degraded Marking,Roadway-No Unusual Conditions,\
    Roadway-Other-See Narrative,Roadway-Traffic Incident,Roadway-Unknown,Roadway-Wet Surface Condition,\
    Roadway-Work Zone,Weather - Clear,Weather - Snow,Weather - Cloudy,Weather - Partly Cloudy,\
    Weather - Fog/Smoke/Haze,Weather - Rain,Weather - Severe Wind,Weather - Dust Storm,Weather - Severe Hurricane,\
    Weather - Structure-Indoor,Weather - Unk - See Narrative,Crash With,Highest Injury Severity Alleged,\
    CP Pre-Crash Movement,CP Contact Area - Rear Left,CP Contact Area - Left,CP Contact Area - Front Left,\
    CP Contact Area - Rear,CP Contact Area - Top,CP Contact Area - Front,CP Contact Area - Rear Right,\
    CP Contact Area - Right,CP Contact Area - Front Right,CP Contact Area - Bottom,CP Contact Area - Unknown,\
    SV Pre-Crash Movement,Any Air Bags Deployed?,Was Any Vehicle Towed?,Were All Passengers Belted?,\
    SV Precrash Speed (MPH),SV Pre-crash Speed - Unknown,SV Contact Area - Rear Left,SV Contact Area - Left,\
    SV Contact Area - Front Left,SV Contact Area - Rear,SV Contact Area - Top,SV Contact Area - Front,\
    SV Contact Area - Rear Right,SV Contact Area - Right,SV Contact Area - Front Right,SV Contact Area - Bottom,\
    SV Contact Area - Unknown,Data Availability - EDR,Data Availability - Police Rpt,Data Availability - Telematics,\
    Data Availability - Complaints,Data Availability - Video,Data Availability - Other,Data Availability - No Data,\
    Data Availability - Unknown,Investigating Agency,Investigating Agency - Unknown,Within ODD?,Within ODD? - CBI,\
    Narrative,Narrative - CBI?";

/// Columns without which a row is no crash record.
const REQUIRED: [&str; 6] =
    ["Report ID", "Report Version", "Roadway Type", "CP Pre-Crash Movement", "SV Pre-Crash Movement", "Narrative"];

/// How many known columns make a line a header.
const LEAST_KNOWN_COLUMNS: usize = 4;

/// A line with more fields than this is no header.
const MOST_COLUMNS: usize = 1000;

/// Weather columns of all editions. `Weather - Unknown`, `- Other`, `- Other Text` and `- Unk - See Narrative` say
/// nothing that a scenario could show.
const WEATHER: [(&str, Weather); 11] = [
    ("Weather - Clear", Weather::Clear),
    ("Weather - Snow", Weather::Snow),
    ("Weather - Cloudy", Weather::Cloudy),
    ("Weather - Partly Cloudy", Weather::Cloudy),
    ("Weather - Fog/Smoke", Weather::Fog),
    ("Weather - Fog/Smoke/Haze", Weather::Fog),
    ("Weather - Rain", Weather::Rain),
    ("Weather - Severe Wind", Weather::SevereWind),
    ("Weather - Dust Storm", Weather::SevereWind),
    ("Weather - Severe Hurricane", Weather::SevereWind),
    ("Weather - Structure-Indoor", Weather::Indoor),
];

/// A column that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Its position; none where the file lacks it.
    pub at: Option<usize>,
    /// Its name, for messages.
    pub name: &'static str,
}

/// Where a row says whether it lay in a work zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorkZoneColumn {
    /// `Roadway Description` holds `Work Zone` (first and second edition).
    Description(Column),
    /// A flag column of its own (third edition).
    Flag(Column),
}

/// Where a row says something of the vehicles of both sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SidesColumns {
    /// A column each, `Yes` or `No` (first and second edition).
    Each { sv: Column, cp: Column },
    /// One column that names both, `Yes Subject Vehicle, No Crash Partner` (third edition).
    Both(Column),
}

/// The columns that are read.
#[derive(Debug, Clone)]
pub struct Columns {
    pub edition: Edition,
    pub width: usize,
    pub report_id: Column,
    pub report_version: Column,
    pub road: Column,
    pub cp_movement: Column,
    pub sv_movement: Column,
    pub narrative: Column,
    pub work_zone: WorkZoneColumn,
    pub entity: Column,
    pub report_type: Column,
    pub make: Column,
    pub model: Column,
    pub model_year: Column,
    pub engaged: Column,
    pub engagement_status: Column,
    pub operator: Column,
    pub date: Column,
    pub time: Column,
    pub incident_id: Column,
    pub city: Column,
    pub state: Column,
    pub surface: Column,
    pub surface_wet: Column,
    pub surface_usual: Column,
    pub posted_speed: Column,
    pub lighting: Column,
    pub crash_with: Column,
    pub severity: Column,
    pub towed: SidesColumns,
    pub airbags: SidesColumns,
    pub sv_speed: Column,
    pub sv_speed_unknown: Column,
    pub weather: Vec<(usize, Weather)>,
    pub sv_zones: Vec<(usize, ContactZone)>,
    pub cp_zones: Vec<(usize, ContactZone)>,
}

/// A header that was recognised, and what is odd about it.
#[derive(Debug, Clone)]
pub struct Recognised {
    pub columns: Columns,
    /// Columns of no edition, as they stand.
    pub unknown: Vec<String>,
    /// Columns that stand more than once; the first is read.
    pub repeated: Vec<String>,
    /// Columns of the edition that are read where they exist, and are not here.
    pub absent: Vec<&'static str>,
}

/// Why a line is no header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NotAHeader {
    /// Next to no known column.
    Unknown,
    /// Known columns, but not all that are needed.
    Missing { edition: Edition, names: Vec<&'static str> },
}

/// The columns of an edition, in its order; none for a mapped file.
pub fn published_header(edition: Edition) -> impl Iterator<Item = &'static str> {
    let header = match edition {
        Edition::First => FIRST_HEADER,
        Edition::Second => SECOND_HEADER,
        Edition::Third => THIRD_HEADER,
        Edition::Mapped => "",
    };
    header.split(',').filter(|name| !name.is_empty())
}

/// How an edition is called in messages.
pub fn edition_name(edition: Edition) -> &'static str {
    match edition {
        Edition::First => "first edition (122 columns, 2021 to mid 2023)",
        Edition::Second => "second edition (137 columns, to June 2025)",
        Edition::Third => "third edition (116 columns, since June 2025)",
        Edition::Mapped => "mapped file",
    }
}

/// Recognises a header by its column names: the edition that shares most of them wins, the later one on a tie.
/// Order, letter case, blanks and the kind of dash do not matter.
pub fn recognise(names: &[String]) -> Result<Recognised, NotAHeader> {
    let header = Header::of(names)?;
    let work_zone = header.work_zone()?;
    let (columns, absent) = header.columns(work_zone);
    let (unknown, repeated) = header.odd_names(names);
    Ok(Recognised { columns, unknown, repeated, absent })
}

/// A line that may be a header, and the edition that it is one of.
struct Header {
    /// The names as they are compared.
    keys: Vec<String>,
    edition: Edition,
}

/// The editions that are published, in the order of time.
const EDITIONS: [Edition; 3] = [Edition::First, Edition::Second, Edition::Third];

impl Header {
    /// The line, where enough of its names stand in a published header.
    fn of(names: &[String]) -> Result<Self, NotAHeader> {
        if names.len() > MOST_COLUMNS {
            return Err(NotAHeader::Unknown);
        }
        let keys: Vec<String> = names.iter().map(|name| header_key(name)).collect();
        let known_in = |edition| published_header(edition).filter(|name| keys.contains(&header_key(name))).count();
        let (known, edition) =
            EDITIONS.into_iter().map(|edition| (known_in(edition), edition)).max().unwrap_or((0, Edition::Second));
        if known < LEAST_KNOWN_COLUMNS {
            return Err(NotAHeader::Unknown);
        }
        Ok(Self { keys, edition })
    }

    /// Where a column of this name stands first.
    fn find(&self, name: &str) -> Option<usize> {
        let wanted = header_key(name);
        self.keys.iter().position(|key| *key == wanted)
    }

    /// The column of this name.
    fn column(&self, name: &'static str) -> Column {
        Column { at: self.find(name), name }
    }

    /// Where the work zone stands, in a line that has all that a crash record needs.
    fn work_zone(&self) -> Result<WorkZoneColumn, NotAHeader> {
        let (flag, description) = (self.column("Roadway-Work Zone"), self.column("Roadway Description"));
        let described = description.at.map(|_| WorkZoneColumn::Description(description));
        let work_zone = flag.at.map(|_| WorkZoneColumn::Flag(flag)).or(described);
        let mut names: Vec<&'static str> = REQUIRED.into_iter().filter(|name| self.find(name).is_none()).collect();
        if work_zone.is_none() {
            names.push(if self.edition == Edition::Third { flag.name } else { description.name });
        }
        match work_zone {
            Some(work_zone) if names.is_empty() => Ok(work_zone),
            _ => Err(NotAHeader::Missing { edition: self.edition, names }),
        }
    }

    /// The positions of all that is read, and which columns of the edition are not here.
    fn columns(&self, work_zone: WorkZoneColumn) -> (Columns, Vec<&'static str>) {
        let mut absent = Vec::new();
        let mut wanted = |name: &'static str| {
            let column = self.column(name);
            if column.at.is_none() && published_header(self.edition).any(|column| column == name) {
                absent.push(name);
            }
            column
        };
        let columns = Columns {
            edition: self.edition,
            width: self.keys.len(),
            report_id: self.column("Report ID"),
            report_version: self.column("Report Version"),
            road: self.column("Roadway Type"),
            cp_movement: self.column("CP Pre-Crash Movement"),
            sv_movement: self.column("SV Pre-Crash Movement"),
            narrative: self.column("Narrative"),
            work_zone,
            entity: wanted("Reporting Entity"),
            report_type: wanted("Report Type"),
            make: wanted("Make"),
            model: wanted("Model"),
            model_year: wanted("Model Year"),
            engaged: wanted("Automation System Engaged?"),
            engagement_status: wanted("Engagement Status"),
            operator: wanted("Operating Entity"),
            date: wanted("Incident Date"),
            time: wanted("Incident Time (24:00)"),
            incident_id: wanted("Same Incident ID"),
            city: wanted("City"),
            state: wanted("State"),
            surface: wanted("Roadway Surface"),
            surface_wet: wanted("Roadway-Wet Surface Condition"),
            surface_usual: wanted("Roadway-No Unusual Conditions"),
            posted_speed: wanted("Posted Speed Limit (MPH)"),
            lighting: wanted("Lighting"),
            crash_with: wanted("Crash With"),
            severity: match wanted("Highest Injury Severity Alleged") {
                Column { at: None, .. } => self.column("Highest Injury Severity"),
                alleged => alleged,
            },
            towed: self.sides(
                "Was Any Vehicle Towed?",
                ["SV Was Vehicle Towed?", "CP Was Vehicle Towed?"],
                &mut wanted,
            ),
            airbags: self.sides(
                "Any Air Bags Deployed?",
                ["SV Any Air Bags Deployed?", "CP Any Air Bags Deployed?"],
                &mut wanted,
            ),
            sv_speed: wanted("SV Precrash Speed (MPH)"),
            sv_speed_unknown: wanted("SV Pre-crash Speed - Unknown"),
            weather: WEATHER.iter().filter_map(|(name, weather)| Some((self.find(name)?, *weather))).collect(),
            sv_zones: self.zones("SV"),
            cp_zones: self.zones("CP"),
        };
        (columns, absent)
    }

    /// The one column that names both sides, or a column for each of them.
    fn sides(
        &self,
        both: &'static str,
        [sv, cp]: [&'static str; 2],
        mut wanted: impl FnMut(&'static str) -> Column,
    ) -> SidesColumns {
        match self.column(both) {
            Column { at: None, .. } => SidesColumns::Each { sv: wanted(sv), cp: wanted(cp) },
            both => SidesColumns::Both(both),
        }
    }

    /// The columns of where one side was touched.
    fn zones(&self, side: &str) -> Vec<(usize, ContactZone)> {
        let column = |zone: ContactZone| Some((self.find(&format!("{side} Contact Area - {}", zone.label()))?, zone));
        ContactZone::ALL.into_iter().filter_map(column).collect()
    }

    /// Names that stand in no edition, and names that stand more than once.
    fn odd_names(&self, names: &[String]) -> (Vec<String>, Vec<String>) {
        let published: BTreeSet<String> = EDITIONS.into_iter().flat_map(published_header).map(header_key).collect();
        let (mut unknown, mut repeated) = (Vec::new(), Vec::new());
        for (position, key) in self.keys.iter().enumerate() {
            if self.keys[..position].contains(key) {
                repeated.push(names[position].trim().to_owned());
            } else if !published.contains(key) {
                unknown.push(names[position].trim().to_owned());
            }
        }
        (unknown, repeated)
    }
}
