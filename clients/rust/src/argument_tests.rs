//! Tests of arguments: amounts, targets, jogs and requests.

use crate::api::distance::Amount;
use crate::errors::{Error, Result};
use crate::jog::axis_jog;
use crate::path::Path;
use crate::target::{Names, Target};
use crate::units::{deg, mm, nm, pulses, um, Distance};
use crate::{api, ALL};

fn amount(distance: Distance) -> Amount {
    distance.message().unwrap().amount.unwrap()
}

#[test]
fn texts_and_integers_are_exact() {
    assert_eq!(amount(mm("1.5")), Amount::Mm("1.5".to_string()));
    assert_eq!(amount(mm(2)), Amount::Mm("2".to_string()));
    assert_eq!(amount(um(-7_i64)), Amount::Um("-7".to_string()));
    assert_eq!(amount(nm(" 1e3 ")), Amount::Nm("1e3".to_string()));
    assert_eq!(amount(-deg("-.5")), Amount::Degrees(".5".to_string()));
    assert_eq!(amount(pulses(5)), Amount::Pulses(5));
}

#[test]
fn floating_point_numbers_are_rounded_by_the_daemon() {
    let Amount::Floating(floating) = amount(mm(0.1 + 0.2)) else { panic!("not a FloatingAmount") };
    assert_eq!(floating.value, 0.1 + 0.2);
    assert_eq!(floating.unit(), api::Unit::Millimeters);
    assert_eq!(floating.rounding(), api::Rounding::Nearest);
}

#[test]
fn other_amounts_are_refused() {
    let wrong = [mm(f64::NAN), mm(f64::NEG_INFINITY), mm("nan"), mm("inf"), mm(""), mm("1,5"), mm("0x1"), mm("--1")];
    for wrong in wrong.into_iter().chain([pulses("1.5"), pulses("x")]) {
        assert!(matches!(wrong.message(), Err(Error::InvalidArgument(_))), "{wrong}");
        assert!(matches!(wrong.per_second().message(), Err(Error::InvalidArgument(_))));
    }
}

#[test]
fn amounts_have_texts() {
    assert_eq!(mm("1.50").to_string(), "1.50 mm");
    assert_eq!(um(2.5).to_string(), "2.5 um");
    assert_eq!(pulses(-3).per_second().to_string(), "-3 pulses/s");
}

#[test]
fn a_negative_speed_jogs_in_the_minus_direction() {
    for speed in [um("-2").per_second(), -um(2).per_second(), um(-2.0).per_second()] {
        let jog = axis_jog("x".to_string(), speed).unwrap();
        assert_eq!(jog.direction(), api::axis_jog::Direction::Minus);
        assert!(jog.speed.is_some_and(|speed| !format!("{speed:?}").contains('-')));
    }
}

#[test]
fn an_error_among_the_points_is_the_error_of_the_path() {
    let axes = ["x".to_string()];
    let points = [Ok([mm(1)]), Err("a point cannot be computed")];
    assert!(matches!(Path::new(&axes, points), Err(Error::Points(error)) if error.to_string().starts_with("a point")));
    assert!(matches!(Path::new(&axes, [[mm(1), mm(2)]]), Err(Error::InvalidArgument(_))));
    assert!(Path::new(&axes, [vec![mm(1)]]).is_ok());
    assert!(matches!(Path::new(&ALL.map(str::to_string), [[mm(1)]]), Err(Error::InvalidArgument(_))));
}

fn found(target: &str, token: &str, environment: &[(&str, &str)]) -> Result<Target> {
    let text = |text: &str| Some(text.to_string()).filter(|text| !text.is_empty());
    let names = Names { target: text(target), token: text(token), ..Names::default() };
    let value = |name: &str| environment.iter().find(|(key, _)| *key == name).map(|(_, value)| value.to_string());
    Target::new(names, value)
}

#[test]
fn targets_have_addresses() {
    for (name, address) in [
        ("/run/a.sock", "unix:/run/a.sock"),
        ("a.sock", "unix:a.sock"),
        ("unix:a", "unix:a"),
        ("lab", "lab:50203"),
        ("lab:1", "lab:1"),
        ("dns:lab", "lab:50203"),
        ("ipv4:127.0.0.1:1", "127.0.0.1:1"),
        ("[::1]", "[::1]:50203"),
        ("::1", "[::1]:50203"),
        ("[::1]:1", "[::1]:1"),
    ] {
        let target = found(name, "", &[]).unwrap();
        assert_eq!(target.address, address);
        assert!(target.endpoint().is_ok(), "{name}");
    }
    assert_eq!(found("lab", "", &[("AXISGATE_CA", "file")]).unwrap().address, "lab:50204");
}

#[test]
fn the_environment_is_the_default() {
    assert_eq!(found("", "", &[("AXISGATE_TARGET", "lab")]).unwrap().address, "lab:50203");
    assert_eq!(found("x.sock", "", &[("AXISGATE_TARGET", "lab")]).unwrap().address, "unix:x.sock");
    assert_eq!(found("", "", &[("AXISGATE_SOCKET", "/a")]).unwrap().address, "unix:/a");
}

#[test]
fn a_token_is_not_sent_in_plain_text() {
    for local in ["127.0.0.1", "localhost:1", "[::1]", "/a/b.sock", "ipv4:127.0.0.1:1"] {
        assert!(found(local, "secret", &[]).is_ok(), "{local}");
    }
    for other in ["lab", "127.0.0.1.example", "192.0.2.1:50203", "dns:lab", "unixbox"] {
        assert!(matches!(found(other, "secret", &[]), Err(Error::InvalidArgument(_))), "{other}");
    }
    assert!(found("lab", "secret", &[("AXISGATE_CA", "file")]).is_ok());
    assert!(matches!(found("lab", "", &[("AXISGATE_KEY", "file")]), Err(Error::InvalidArgument(_))));
}
