//! Set II over many courses, as run by `eeruf lab experiment set-two`.

use std::sync::atomic::{AtomicUsize, Ordering};

use eeruf_sim::{
    Entry, LabMate, Method, Physics, Point,
    experiments::{
        ExperimentError,
        set_two::{
            Ending, Figures, OdometryNoise, Pilots, SECOND_AHEAD, SECOND_BEHIND, SetTwo, SetTwoOptions, set_two,
            speed_sweep,
        },
    },
};

fn options(seeds: u64, methods: &[Method]) -> SetTwoOptions {
    SetTwoOptions { seeds, methods: Entry::all(methods.iter().copied()), ..SetTwoOptions::default() }
}

fn of(found: &SetTwo, method: Method) -> Figures {
    found.methods.iter().find(|(of, _)| of == method.as_str()).unwrap().1
}

// EERUF finishes 95 of 100 courses at 0.8 m/s or more alone, and 90 beside a second robot.
#[test]
fn eeruf_finishes_95_of_100_courses() {
    for physics in [Physics::PLAIN, Physics::DEFAULT] {
        for (second_robot, least) in [(None, 95), (Some(SECOND_BEHIND), 90)] {
            let asked = SetTwoOptions { second_robot, physics, ..options(100, &[Method::Eeruf]) };
            let eeruf = of(&set_two(&asked, &|_| true).unwrap(), Method::Eeruf);
            assert!(eeruf.finished >= least && eeruf.mean_speed_m_s >= 0.8, "{physics} {eeruf:?}");
        }
    }
}

// With bodies the second robot is an obstacle, and courses are still finished.
#[test]
fn second_robots_body_is_an_obstacle() {
    let run = |bodies, second_robot| {
        let asked = SetTwoOptions { bodies, second_robot, ..options(20, &[Method::Eeruf, Method::Conventional]) };
        set_two(&asked, &|_| true).unwrap()
    };
    for second_robot in [None, Some(SECOND_AHEAD)] {
        let (without, with) = (run(false, second_robot), run(true, second_robot));
        assert!(with.bodies && !without.bodies);
        let eeruf = of(&with, Method::Eeruf);
        assert!(eeruf.finished > 10, "{eeruf:?}");
        // The ring on the platform's edge hears other echoes than a ring on its middle.
        assert!(with.runs.iter().flatten().zip(without.runs.iter().flatten()).all(|(a, b)| a.track != b.track));
    }
    // The first robot runs into a robot in its way or drives round it, but never through it.
    let in_the_way = Point::new(2.0, 3.5);
    for run in run(true, Some(in_the_way)).runs.iter().flatten() {
        for place in &run.track {
            let from_middle = (Point::new(place.x_m, place.y_m) - in_the_way).norm();
            assert!(from_middle > 0.3 + 0.375 - 0.03, "{} {from_middle}", run.course);
        }
    }
}

#[test]
fn in_the_labs_rectangle_the_width_of_walls_changes_nothing() {
    // The claim is in docs/explanation/physics.md.
    let without = Physics { narrow_panels: false, ..Physics::DEFAULT };
    for (second_robot, bodies) in [(None, false), (Some(SECOND_BEHIND), false), (Some(SECOND_AHEAD), true)] {
        let run = |physics| {
            let methods = [Method::Conventional, Method::Eeruf, Method::MultiEcho];
            set_two(&SetTwoOptions { physics, second_robot, bodies, ..options(3, &methods) }, &|_| true).unwrap().runs
        };
        assert_eq!(run(Physics::DEFAULT), run(without));
    }
}

// With its own pilot, conventional firing finishes more than half of the courses.
#[test]
fn own_pilot_brings_conventional_through_half_the_courses() {
    for second_robot in [None, Some(SECOND_BEHIND), Some(SECOND_AHEAD)] {
        let asked = SetTwoOptions { second_robot, ..options(40, &[Method::Conventional]) };
        let conventional = of(&set_two(&asked, &|_| true).unwrap(), Method::Conventional);
        assert!(conventional.finished > 20, "{conventional:?}");
    }
}

// With the pilot shared with EERUF, constant lags fill the grid with phantoms.
#[test]
fn shared_pilot_fills_the_grid_with_phantoms() {
    for second_robot in [None, Some(SECOND_BEHIND)] {
        let asked = options(20, &[Method::Conventional, Method::Comparison, Method::Eeruf]);
        let found = set_two(&SetTwoOptions { second_robot, pilots: Pilots::Shared, ..asked }, &|_| true).unwrap();
        let eeruf = of(&found, Method::Eeruf);
        assert!(eeruf.finished >= 18, "{eeruf:?}");
        for method in [Method::Conventional, Method::Comparison] {
            let other = of(&found, method);
            assert!(other.finished <= 10 && other.phantom_echoes > 10.0 * eeruf.phantom_echoes, "{method} {other:?}");
        }
    }
}

// Each pilot, and the noise of odometry, changes the drive on a course.
#[test]
fn pilot_and_noise_change_the_drive() {
    let track = |pilots, odometry_noise| {
        let asked = SetTwoOptions { pilots, odometry_noise, ..options(1, &[Method::Eeruf]) };
        set_two(&asked, &|_| true).unwrap().runs[0][0].track.clone()
    };
    let noisy = OdometryNoise::default();
    let mut tracks: Vec<_> = Pilots::NAMED.map(|pilots| track(pilots, noisy)).into();
    tracks.push(track(Pilots::Own, OdometryNoise::NONE));
    for (k, one) in tracks.iter().enumerate() {
        assert!(tracks[..k].iter().all(|other| other != one), "{k}");
    }
    assert_eq!(tracks[0], track(Pilots::Own, noisy));
}

#[test]
fn every_course_tells_where_the_robot_drove_and_how_it_ended() {
    let found = set_two(&options(6, &[Method::Conventional, Method::Eeruf]), &|_| true).unwrap();
    for ((method, figures), runs) in found.methods.iter().zip(&found.runs) {
        assert_eq!((figures.courses, runs.len()), (6, 6));
        assert_eq!(figures.finished + figures.contacts + figures.timed_out, 6);
        for run in runs {
            let last = run.track.last().unwrap();
            match run.ending {
                Ending::Finished => assert!(last.x_m > 8.1 && run.nearest_m > 0.0, "{method}"),
                Ending::Contact => assert!(last.x_m < 9.7, "{method}"),
                Ending::TimeOut => assert!(run.time_s >= 39.9, "{method}"),
            }
            // The platform drives no faster than its limit, and along its heading.
            for pair in run.track.windows(2) {
                let (dx, dy) = (pair[1].x_m - pair[0].x_m, pair[1].y_m - pair[0].y_m);
                assert!(dx.hypot(dy) <= 1.0 * (pair[1].time_s - pair[0].time_s) + 1e-9);
                let heading = 0.5 * (pair[0].heading_rad + pair[1].heading_rad);
                let turned = (pair[1].heading_rad - pair[0].heading_rad).abs() < 1.0;
                assert!(!turned || (dy * heading.cos() - dx * heading.sin()).abs() < 1e-3);
            }
            assert!(run.grid.iter().all(|cell| (1..=15).contains(&cell.value)));
        }
    }
}

#[test]
fn set_two_is_the_same_on_any_number_of_threads() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let asked =
            SetTwoOptions { second_robot: Some(SECOND_AHEAD), ..options(3, &[Method::Eeruf, Method::Adaptive]) };
        pool.install(|| set_two(&asked, &|_| true).unwrap())
    };
    assert_eq!(on(1), on(2));
}

#[test]
fn a_sweep_tells_at_each_speed_what_a_run_at_that_speed_tells() {
    let asked = options(4, &[Method::Eeruf, Method::Sequential]);
    let steps = speed_sweep(&asked, &[0.5, 1.5], &|_| true).unwrap();
    assert_eq!(steps.iter().map(|step| step.speed_m_s).collect::<Vec<_>>(), [0.5, 1.5]);
    for step in &steps {
        let labmate = LabMate { speed_max_m_s: step.speed_m_s, ..LabMate::default() };
        let found = set_two(&SetTwoOptions { labmate, ..asked.clone() }, &|_| true).unwrap();
        for (place, (method, figures)) in found.methods.iter().enumerate() {
            assert_eq!(step.finished[place], (method.clone(), figures.finished as f64 / 4.0));
            assert_eq!(step.finished_95[place], (method.clone(), figures.finished_95));
            assert_eq!(step.mean_speed_m_s[place], (method.clone(), figures.mean_speed_m_s));
            assert!(figures.top_speed_m_s <= step.speed_m_s && figures.mean_speed_m_s < figures.top_speed_m_s);
        }
    }
    assert!(steps[1].mean_speed_m_s[0].1 > 1.5 * steps[0].mean_speed_m_s[0].1);
}

#[test]
fn set_two_stops_when_it_is_told_to_and_refuses_to_do_nothing() {
    let calls = AtomicUsize::new(0);
    let stop = |_| calls.fetch_add(1, Ordering::Relaxed) < 2;
    assert_eq!(set_two(&options(1000, &[Method::Eeruf]), &stop), Err(ExperimentError::Stopped));
    assert!(calls.into_inner() < 20);
    let error = |asked: &SetTwoOptions| set_two(asked, &|_| true).unwrap_err().to_string();
    assert_eq!(error(&options(0, &[Method::Eeruf])), "0 seeds; expected at least one");
    assert_eq!(error(&options(1, &[])), "no methods; expected at least one");
    let beyond = SetTwoOptions { first: u64::MAX - 1, ..options(3, &[Method::Eeruf]) };
    let expected = "3 seeds from 18446744073709551614 on; expected a last one of at most 18446744073709551614";
    assert_eq!(error(&beyond), expected);
}
