//! Logs in the forms that people have, each with its right answer.

use std::io::Write as _;
use std::path::Path;

use eeruf_logs::{Echo, FieldChoice, Options, Pattern, RangeUnit, Report, Table, read_log, read_stream};

/// A log's contents: each sensor's name and its ranges in metres, `-` for no echo, `<` for too close, `!` for no
/// number; and the seconds between its first two readings.
pub(crate) fn said(bytes: &[u8], options: &Options) -> (String, Option<f64>, Report) {
    let mut readings = vec![];
    let report = read_stream(bytes, Path::new("log"), options, |_, reading| readings.push(*reading)).unwrap();
    let text = |sensor: usize| {
        let own = readings.iter().filter(|reading| reading.sensor == sensor).map(|reading| match reading.echo() {
            Echo::At(range_m) => format!(" {}", (range_m * 1000.0).round() / 1000.0),
            Echo::Nothing => " -".to_owned(),
            Echo::TooClose => " <".to_owned(),
            Echo::Invalid => " !".to_owned(),
        });
        report.names()[sensor].clone() + ":" + &own.collect::<String>()
    };
    let sensors: Vec<_> = (0..report.sensors.len()).map(text).collect();
    let mut first = readings.iter().filter(|reading| reading.sensor == 0).filter_map(|reading| reading.at_ns);
    let step = first.next().zip(first.next()).map(|(one, two)| (two as f64 - one as f64) * 1e-9);
    (sensors.join("; "), step, report)
}

/// Name, text, sensors, and seconds between the first two readings.
pub(crate) type Form = (&'static str, &'static str, &'static str, Option<f64>);

const FORMS: [Form; 106] = [
    ("comma", "left,right\n40,80\n41,81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("semicolon", "left;right\n40;80\n41;81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("tab", "left\tright\n40\t80\n41\t81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("bar", "left|right\n40|80\n41|81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("names and values by turns", "left 40 right 80\nleft 41 right 81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("spaces", "left right\n 40  80\n 41  81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("CRLF", "left,right\r\n40,80\r\n41,81\r\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("CR", "left,right\r40,80\r41,81\r", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("BOM", "\u{feff}left,right\n40,80\n41,81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("decimal comma", "left;right\n40,5;80,1\n41,5;81,1\n", "left: 0.405 0.415; right: 0.801 0.811", None),
    ("decimal comma in quotes", "l,r\n\"40,5\",\"80,1\"\n\"41,5\",\"81,1\"\n", "l: 0.405 0.415; r: 0.801 0.811", None),
    ("decimal comma, one name", "left\n40,5\n41,5\n", "left: 0.405 0.415", None),
    ("comments", "# ring 1\nleft,right\n# wall\n40,80\n\n41,81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("header in a comment", "# left,right\n40,80\n41,81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("Excel's first line", "sep=;\nleft;right\n40;80\n41;81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("greeting", "Starting sonar\nleft,right\n40,80\n41,81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("row of units", "t,left,right\ns,cm,mm\n0.0,40,800\n0.1,41,810\n", "left: 0.4 0.41; right: 0.8 0.81", Some(0.1)),
    ("header again", "left,right\n40,80\nleft,right\n41,81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("no header", "40,80\n41,81\n40,80\n", "column 1: 0.4 0.41 0.4; column 2: 0.8 0.81 0.8", None),
    ("comma at the end", "left,right\n40,80,\n41,81,\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("unit in the header", "left_mm,right_mm\n400,800\n410,810\n", "left_mm: 0.4 0.41; right_mm: 0.8 0.81", None),
    ("unit in brackets", "left [in]\n10\n20\n", "left [in]: 0.254 0.508", None),
    ("unit in the cell", "left,right\n40cm,80 cm\n41cm,81 cm\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    ("metres by magnitude", "left,right\n0.40,2.80\n0.41,2.81\n", "left: 0.4 0.41; right: 2.8 2.81", None),
    ("millimetres by magnitude", "left,right\n400,2800\n410,2810\n", "left: 0.4 0.41; right: 2.8 2.81", None),
    ("echo times by name", "echo_us\n10000\n20000\n", "echo_us: 1.716 3.432", None),
    ("echo times by magnitude", "a\n11655\n23310\n", "a: 2 4", None),
    ("zero is no echo", "left\n0\n40\n0\n41\n", "left: - 0.4 - 0.41", None),
    ("words for no echo", "left\nNone\n40\nnan\ninf\nN/A\n--\n41\n", "left: - 0.4 - - - - 0.41", None),
    ("far is no echo", "left\n40\n999\n65535\n40\n", "left: 0.4 - - 0.4", None),
    ("ceiling is no echo", "left\n40\n400\n41\n400\n400\n40\n", "left: 0.4 - 0.41 - - 0.4", None),
    ("too close by REP 117", "left\n0.4\n-inf\n0.5\n", "left: 0.4 < 0.5", None),
    ("millis", "millis,left\n1000,40\n1060,41\n", "left: 0.4 0.41", Some(0.06)),
    ("micros", "micros,left\n1000000,40\n1060000,41\n", "left: 0.4 0.41", Some(0.06)),
    ("seconds since 1970", "timestamp,left\n1700000000.0,40\n1700000000.06,41\n", "left: 0.4 0.41", Some(0.06)),
    ("ISO 8601", "time,left\n2024-01-02T12:00:00.00Z,40\n2024-01-02T12:00:00.06Z,41\n", "left: 0.4 0.41", Some(0.06)),
    ("date and time", "date,time,a\n2024-01-02,12:00:00.10,40\n2024-01-02,12:00:00.16,41\n", "a: 0.4 0.41", Some(0.06)),
    ("counter and battery", "seq,battery,left\n1,11.9,40\n2,11.8,41\n3,11.8,42\n", "left: 0.4 0.41 0.42", None),
    ("sensor in a column", "t,sensor,cm\n0.0,a,40\n0.1,b,80\n0.2,a,41\n", "a: 0.4 0.41; b: 0.8", Some(0.2)),
    (
        "rostopic echo -p",
        "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.radiation_type,\
      field.field_of_view,field.min_range,field.max_range,field.range\n1700000000000000000,1,1700000000000000000,us1,0,\
      0.5,0.02,4.0,1.25\n1700000000100000000,2,1700000000100000000,us1,0,0.5,0.02,4.0,4.0\n",
        "us1: 1.25 -",
        Some(0.1),
    ),
    (
        "serial monitor",
        "12:00:01.100 -> 40,80\n12:00:01.160 -> 41,81\n12:00:01.220 -> 40,80\n",
        "column 1: 0.4 0.41 0.4; column 2: 0.8 0.81 0.8",
        Some(0.06),
    ),
    (
        "seconds, no header",
        "0.1 40 80\n0.2 41 81\n0.3 40 80\n",
        "column 2: 0.4 0.41 0.4; column 3: 0.8 0.81 0.8",
        Some(0.1),
    ),
    ("ROS console", "[INFO] [17.100]: left: 0.40\n[INFO] [17.200]: left: 0.41\n", "left: 0.4 0.41", Some(0.1)),
    (
        "name and value",
        "left: 40 cm\nright: 80 cm\nleft: 41 cm\nright: out of range\n",
        "left: 0.4 0.41; right: 0.8 -",
        None,
    ),
    ("serial plotter", "left:40,right:80\nleft:41,right:81\n", "left: 0.4 0.41; right: 0.8 0.81", None),
    (
        "JSON lines",
        "{\"t\":0.1,\"front\":40,\"back\":null}\n{\"t\":0.2,\"front\":41,\"back\":81}\n",
        "front: 0.4 0.41; back: - 0.81",
        Some(0.1),
    ),
    (
        "JSON document",
        "[\n {\"t\": 0.1, \"us\": {\"left\": 40}},\n {\"t\": 0.2, \"us\": {\"left\": 41}}\n]\n",
        "us.left: 0.4 0.41",
        Some(0.1),
    ),
    ("NewPing's example", "0=40cm 1=80cm \n0=41cm 1=0cm \n0=40cm 1=81cm \n", "0: 0.4 0.41 0.4; 1: 0.8 - 0.81", None),
    (
        "Python's print of a dict",
        "{'t': 0.1, 'left': 40.5, 'right': None}\n{'t': 0.2, 'left': 41.5, 'right': 81.0}\n",
        "left: 0.405 0.415; right: - 0.81",
        Some(0.1),
    ),
    (
        "ros2 topic echo",
        "header:\n  stamp:\n    sec: 7\n    nanosec: 0\n  frame_id: us_1\nradiation_type: 0\nfield_of_view: 0.5\n\
         min_range: 0.02\nmax_range: 4.0\nrange: 1.25\n---\nheader:\n  stamp:\n    sec: 7\n    nanosec: 60000000\n  \
         frame_id: us_1\nradiation_type: 0\nfield_of_view: 0.5\nmin_range: 0.02\nmax_range: 4.0\nrange: .inf\n---\n",
        "us_1: 1.25 -",
        Some(0.06),
    ),
    (
        "rostopic echo",
        "header: \n  seq: 1\n  stamp: \n    secs: 7\n    nsecs:         0\n  frame_id: \"us1\"\nradiation_type: 0\n\
         field_of_view: 0.5\nmin_range: 0.02\nmax_range: 4.0\nrange: 1.25\n---\nheader: \n  seq: 2\n  stamp: \n    \
         secs: 7\n    nsecs:  60000000\n  frame_id: \"us1\"\nradiation_type: 0\nfield_of_view: 0.5\nmin_range: 0.02\n\
         max_range: 4.0\nrange: 1.5\n---\n",
        "us1: 1.25 1.5",
        Some(0.06),
    ),
    (
        "ros2 topic echo --csv",
        "7,0,us_1,0,0.26,0.02,4.0,1.25\n7,60000000,us_1,0,0.26,0.02,4.0,1.5\n",
        "us_1: 1.25 1.5",
        Some(0.06),
    ),
    (
        "one sensor a row",
        "t,a,b\n0.0,40,\n0.1,,80\n0.2,41,\n0.3,,81\n0.4,40,\n0.5,,80\n0.6,41,\n0.7,,81\n",
        "a: 0.4 0.41 0.4 0.41; b: 0.8 0.81 0.8 0.81",
        Some(0.2),
    ),
    (
        "mavlogdump",
        "timestamp,DISTANCE_SENSOR.time_boot_ms,DISTANCE_SENSOR.min_distance,DISTANCE_SENSOR.max_distance,\
         DISTANCE_SENSOR.current_distance,DISTANCE_SENSOR.type,DISTANCE_SENSOR.id,DISTANCE_SENSOR.orientation\n\
         1700000000.00,0,2,400,40,1,0,0\n1700000000.03,30,2,400,80,1,1,2\n1700000000.06,60,2,400,41,1,0,0\n",
        "0: 0.4 0.41; 1: 0.8",
        Some(0.06),
    ),
    ("ESP-IDF", "I (50) us: left: 40 cm\nI (110) us: left: 41 cm\n", "left: 0.4 0.41", Some(0.06)),
    (
        "syslog",
        "Jan  2 12:00:01.100 robot us[7]: left=40cm\nJan  2 12:00:01.160 robot us[7]: left=41cm\n",
        "left: 0.4 0.41",
        Some(0.06),
    ),
    ("feet", "t (ms),Distance (ft)\n0,1.5\n60,2\n", "Distance (ft): 0.457 0.61", Some(0.06)),
    (
        "Home Assistant",
        "entity_id,state,last_changed\nsensor.us_1,40.5,2026-01-01T14:00:00.000000+00:00\n\
         sensor.us_1,41.5,2026-01-01T14:00:00.060000+00:00\n",
        "sensor.us_1: 0.405 0.415",
        Some(0.06),
    ),
    (
        "InfluxDB",
        "#datatype,string,long,dateTime:RFC3339,dateTime:RFC3339,double,string,string\n\
         ,result,table,_start,_time,_value,_field,sensor\n\
         ,,0,2026-01-01T00:00:00Z,2026-01-01T14:00:00.00Z,0.40,range,a\n\
         ,,1,2026-01-01T00:00:00Z,2026-01-01T14:00:00.03Z,0.80,range,b\n\
         ,,0,2026-01-01T00:00:00Z,2026-01-01T14:00:00.06Z,0.41,range,a\n",
        "a: 0.4 0.41; b: 0.8",
        Some(0.06),
    ),
    (
        "ThingSpeak",
        "created_at,entry_id,field1,field2\n2026-01-01 14:00:00 UTC,1,40,80\n2026-01-01 14:00:15 UTC,2,41,81\n\
         2026-01-01 14:00:30 UTC,3,40,80\n",
        "field1: 0.4 0.41 0.4; field2: 0.8 0.81 0.8",
        Some(15.0),
    ),
    (
        "Python's print of a tuple",
        "(0.1, [40, 80])\n(0.2, [41, 81])\n(0.3, [40, 80])\n",
        "column 2: 0.4 0.41 0.4; column 3: 0.8 0.81 0.8",
        Some(0.1),
    ),
    (
        "MATLAB",
        "% run 3\n% t[s] d1[m] d2[m]\n0.10 0.40 0.80\n0.20 0.41 0.81\n",
        "d1[m]: 0.4 0.41; d2[m]: 0.8 0.81",
        Some(0.1),
    ),
    (
        "JSON, a list in an object on one line",
        "{\"robot\":\"x\",\"readings\":[{\"t\":0.1,\"id\":\"a\",\"cm\":40},\
     {\"t\":0.2,\"id\":\"a\",\"cm\":41}]}",
        "a: 0.4 0.41",
        Some(0.1),
    ),
    (
        "JSON of columns",
        "{\"t\":[0.1,0.2],\"left\":[40,41],\"right\":[80,null]}",
        "left: 0.4 0.41; right: 0.8 -",
        Some(0.1),
    ),
    ("JSON of pandas", "{\"t\":{\"0\":0.1,\"1\":0.2},\"left\":{\"0\":40,\"1\":41}}", "left: 0.4 0.41", Some(0.1)),
    (
        "sensor and distance as objects",
        "{\"t\":0.0,\"sensor\":{\"id\":\"a\"},\"distance\":{\"value\":40.5,\"unit\":\"cm\"}}\n\
         {\"t\":0.1,\"sensor\":{\"id\":\"a\"},\"distance\":{\"value\":41.5,\"unit\":\"cm\"}}\n",
        "a: 0.405 0.415",
        Some(0.1),
    ),
    (
        "Python's logging",
        "2026-01-01 14:00:00,100 - sonar - INFO - left: 40.1 cm\n2026-01-01 14:00:00,150 - sonar - INFO - le\
         ft: 41.1 cm\n",
        "left: 0.401 0.411",
        Some(0.05),
    ),
    (
        "Python's logging, its usual form",
        "INFO:sonar:left: 40.1 cm\nINFO:sonar:left: 41.1 cm\n",
        "left: 0.401 0.411",
        None,
    ),
    (
        "ros2 launch",
        "[us_node-1] [INFO] [1700000000.100000000] [us_node]: left: 0.40\n[us_node-1] [INFO] [1700000000.150\
         000000] [us_node]: left: 0.41\n",
        "left: 0.4 0.41",
        Some(0.05),
    ),
    (
        "journalctl",
        "2026-01-01T14:00:00.00+0100 robot us[7]: left=40cm\n2026-01-01T14:00:00.05+0100 robot us[7]: left=4\
         1cm\n",
        "left: 0.4 0.41",
        Some(0.05),
    ),
    (
        "ts",
        "Jan 02 12:00:01 40,80\nJan 02 12:00:02 41,81\nJan 02 12:00:03 40,80\n",
        "column 1: 0.4 0.41 0.4; column 2: 0.8 0.81 0.8",
        Some(1.0),
    ),
    (
        "Tera Term",
        "[Tue Jan 02 12:00:01.100 2024] 40,80\n[Tue Jan 02 12:00:01.150 2024] 41,81\n[Tue Jan 02 12:00:01.20\
         0 2024] 40,80\n",
        "column 1: 0.4 0.41 0.4; column 2: 0.8 0.81 0.8",
        Some(0.05),
    ),
    (
        "grabserial",
        "[1.234567 0.012345] 40,80\n[1.284567 0.050000] 41,81\n[1.334567 0.050000] 40,80\n",
        "column 1: 0.4 0.41 0.4; column 2: 0.8 0.81 0.8",
        Some(0.05),
    ),
    (
        "ESP-IDF in colours",
        "\u{1b}[0;32mI (50) us: left: 40 cm\u{1b}[0m\n\u{1b}[0;32mI (110) us: left: 41 cm\u{1b}[0m\n",
        "left: 0.4 0.41",
        Some(0.06),
    ),
    ("micros that wrap", "micros,left\n4294950000,40\n32704,41\n82704,40\n", "left: 0.4 0.41 0.4", Some(0.05)),
    (
        "seconds and microseconds",
        "tv_sec,tv_usec,left\n1700000000,950000,40\n1700000001,0,41\n",
        "left: 0.4 0.41",
        Some(0.05),
    ),
    (
        "a clock of 12 hours",
        "time,left\n1/2/2024 11:59:59 AM,40\n1/2/2024 12:00:00 PM,41\n1/2/2024 12:00:01 PM,40\n",
        "left: 0.4 0.41 0.4",
        Some(1.0),
    ),
    (
        "pandas' time differences",
        "time,left\n0 days 00:00:00,40\n0 days 00:00:00.050000,41\n0 days 00:00:00.100000,40\n",
        "left: 0.4 0.41 0.4",
        Some(0.05),
    ),
    (
        "index of dates",
        ",left,right\n2026-01-01 14:00:00.000000,40.1,80.2\n2026-01-01 14:00:00.050000,40.2,80.3\n",
        "left: 0.401 0.402; right: 0.802 0.803",
        Some(0.05),
    ),
    (
        "a unit in each row",
        "time,sensor,range,unit\n0.0,left,40,cm\n0.1,right,800,mm\n0.2,left,41,cm\n0.3,right,810,mm\n",
        "left: 0.4 0.41; right: 0.8 0.81",
        Some(0.2),
    ),
    ("ros2 topic echo --field", "1.25\n---\n1.26\n---\n.inf\n---\n1.25\n---\n", "column 1: 1.25 1.26 - 1.25", None),
    (
        "DataFlash as text",
        "FMT, 167, 16, RFND, QBCBB, TimeUS,Instance,Dist,Stat,Orient\nRFND, 1000000, 0, 1.23, 4, 25\nRFND, 1\
         050000, 0, 7.00, 3, 25\nRFND, 1100000, 0, 0.10, 2, 25\nRFND, 1150000, 0, 0.00, 1, 25\n",
        "0: 1.23 - < -",
        Some(0.05),
    ),
    (
        "ulog2csv",
        "timestamp,device_id,min_distance,max_distance,current_distance,variance,signal_quality,h_fov,v_fov,\
         q[0],q[1],q[2],q[3],type,orientation\n12345678,8388649,0.2,7.65,1.23,0,-1,0.5,0.5,0,0,0,0,1,25\n1239\
         5678,8388649,0.2,7.65,1.24,0,-1,0.5,0.5,0,0,0,0,1,25\n12445678,8388649,0.2,7.65,1.23,0,-1,0.5,0.5,0,\
         0,0,0,1,25\n",
        "8388649: 1.23 1.24 1.23",
        Some(0.05),
    ),
    (
        "mavlogdump, a laser",
        "timestamp,DISTANCE_SENSOR.time_boot_ms,DISTANCE_SENSOR.min_distance,DISTANCE_SENSOR.max_distance,DI\
         STANCE_SENSOR.current_distance,DISTANCE_SENSOR.type,DISTANCE_SENSOR.id,DISTANCE_SENSOR.orientation\n\
         1700000000.00,0,2,400,39,0,0,0\n1700000000.03,30,2,400,80,1,1,0\n1700000000.06,60,2,400,38,0,0,0\n17\
         00000000.09,90,2,400,81,1,1,0\n",
        "1: 0.8 0.81",
        Some(0.06),
    ),
    (
        "ros2 topic echo, infrared",
        "header:\n  stamp:\n    sec: 7\n    nanosec: 0\n  frame_id: us\nradiation_type: 0\nfield_of_view: 0.\
         5\nmin_range: 0.02\nmax_range: 4.0\nrange: 0.4\n---\nheader:\n  stamp:\n    sec: 7\n    nanosec: 500\
         00000\n  frame_id: ir\nradiation_type: 1\nfield_of_view: 0.5\nmin_range: 0.02\nmax_range: 4.0\nrange\
         : 0.8\n---\nheader:\n  stamp:\n    sec: 7\n    nanosec: 100000000\n  frame_id: us\nradiation_type: 0\
         \nfield_of_view: 0.5\nmin_range: 0.02\nmax_range: 4.0\nrange: 0.41\n---\nheader:\n  stamp:\n    sec: \
         7\n    nanosec: 150000000\n  frame_id: ir\nradiation_type: 1\nfield_of_view: 0.5\nmin_range: 0.02\nm\
         ax_range: 4.0\nrange: 0.81\n---\n",
        "us: 0.4 0.41",
        Some(0.1),
    ),
    (
        "beyond limits, pairs",
        "left: 40 cm, right: >400 cm\nleft: <2 cm, right: 80 cm\nleft: 41 cm, right: 81 cm\n",
        "left: 0.4 < 0.41; right: - 0.8 0.81",
        None,
    ),
    (
        "beyond limits, cells",
        "left,right\n40,>400\n<2,80\n41,81\n40,80\n",
        "left: 0.4 < 0.41 0.4; right: - 0.8 0.81 0.8",
        None,
    ),
    (
        "words with units",
        "Left: 40.1 cm Right: -- cm\nLeft: inf cm Right: 80.1 cm\nLeft: nan cm Right: 80.2 cm\nLeft: 40.2 cm \
         Right: None cm\n",
        "Left: 0.401 - - 0.402; Right: - 0.801 0.802 -",
        None,
    ),
    (
        "names before values",
        "F40 L80 R120\nF41 L81 R121\nF40 L80 R0\n",
        "F: 0.4 0.41 0.4; L: 0.8 0.81 0.8; R: 1.2 1.21 -",
        None,
    ),
    ("MaxBotix", "R0756\rR0757\rR5000\rR0756\r", "R: 0.756 0.757 - 0.756", None),
    (
        "packets in brackets",
        "<40,80,120>\n<41,81,121>\n<40,80,120>\n",
        "column 1: 0.4 0.41 0.4; column 2: 0.8 0.81 0.8; column 3: 1.2 1.21 1.2",
        None,
    ),
    (
        "NMEA 0183",
        "$SONAR,40,80*2F\r\n$SONAR,41,81*2F\r\n$SONAR,40,80*2F\r\n",
        "column 2: 0.4 0.41 0.4; column 3: 0.8 0.81 0.8",
        None,
    ),
    (
        "names that are numbers",
        "time,0,1,2\n0.0,40,80,120\n0.1,41,81,121\n0.2,40,80,120\n",
        "0: 0.4 0.41 0.4; 1: 0.8 0.81 0.8; 2: 1.2 1.21 1.2",
        Some(0.1),
    ),
    (
        "print of pandas",
        "     t  left  right\n0  0.0    40     80\n1  0.1    41     81\n2  0.2    40     80\n",
        "left: 0.4 0.41 0.4; right: 0.8 0.81 0.8",
        Some(0.1),
    ),
    (
        "psql",
        "  t  | left | right \n-----+------+-------\n 0.0 |   40 |    80\n 0.1 |   41 |    81\n(2 rows)\n",
        "left: 0.4 0.41; right: 0.8 0.81",
        Some(0.1),
    ),
    (
        "columns of a robot",
        "t,us_front,batt_v,enc_l,imu_ax,left_ticks,tof_left,moving,us_front_ok\n0.0,40,11.9,100,0.1,7,39,1,1\
         \n0.1,41,11.8,107,0.1,9,38,0,1\n0.2,40,11.9,114,0.1,8,39,1,0\n",
        "us_front: 0.4 0.41 -",
        Some(0.1),
    ),
    (
        "sensors in turn, no header",
        "1,40\n2,80\n3,120\n1,41\n2,81\n3,121\n1,40\n2,80\n3,120\n",
        "1: 0.4 0.41 0.4; 2: 0.8 0.81 0.8; 3: 1.2 1.21 1.2",
        None,
    ),
    ("addresses", "0x70: 40 cm\n0x71: 80 cm\n0x70: 41 cm\n0x71: 81 cm\n", "0x70: 0.4 0.41; 0x71: 0.8 0.81", None),
    ("the range in two units", "Distance: 40 cm (15.7 in)\nDistance: 41 cm (16.1 in)\n", "Distance: 0.4 0.41", None),
    (
        "other quantities",
        "Distance: 40.1 cm, Temp: 21.5 C, Batt: 11.9 V\nDistance: 41.1 cm, Temp: 21.5 C, Batt: 11.9 V\n",
        "Distance: 0.401 0.411",
        None,
    ),
    (
        "time from 0 without a header",
        "0,A,40\n10,B,80\n20,A,41\n30,B,81\n40,A,40\n50,B,80\n60,A,41\n70,B,81\n",
        "A: 0.4 0.41 0.4 0.41; B: 0.8 0.81 0.8 0.81",
        Some(0.02),
    ),
    (
        "a word, then times",
        "SONAR,600,40,80\nSONAR,700,41,81\nSONAR,800,40,80\nSONAR,900,41,81\n",
        "column 3: 0.4 0.41 0.4 0.41; column 4: 0.8 0.81 0.8 0.81",
        Some(0.1),
    ),
    (
        "milliseconds and a colon",
        "100 ms: sonar[0]=0.40 m sonar[1]=0.80 m\n150 ms: sonar[0]=0.41 m sonar[1]=0.81 m\n",
        "sonar[0]: 0.4 0.41; sonar[1]: 0.8 0.81",
        Some(0.05),
    ),
    (
        "time with its unit",
        "1.5s: left=40 right=80\n1.6s: left=41 right=81\n",
        "left: 0.4 0.41; right: 0.8 0.81",
        Some(0.1),
    ),
    (
        "unit in brackets",
        "[1500 ms] left=40 right=80\n[1600 ms] left=41 right=81\n",
        "left: 0.4 0.41; right: 0.8 0.81",
        Some(0.1),
    ),
    (
        "greeting again",
        "HC-SR04 test\nmillis,left\n1000,40\n1050,41\nHC-SR04 test\nmillis,left\n20,41\n70,40\n",
        "left: 0.4 0.41 0.41 0.4",
        Some(0.05),
    ),
];

#[test]
fn each_form_gives_its_right_answer() {
    for (name, text, sensors, step) in FORMS {
        let (found, seconds, report) = said(text.as_bytes(), &Options::default());
        assert_eq!(found, sensors, "{name}: {:#?}", report.guesses);
        assert_eq!(report.damage, [], "{name}");
        let is_near = step.zip(seconds).is_none_or(|(step, seconds)| (step - seconds).abs() < 1e-6);
        assert!(is_near && step.is_some() == seconds.is_some(), "{name}: {seconds:?} {:#?}", report.guesses);
        assert!(!report.form.is_empty() && report.guesses.iter().all(|guess| guess.option.starts_with("--")), "{name}");
    }
}

// A message that nothing ends may be cut in the middle of a number.
#[test]
fn message_that_is_not_ended_gives_no_reading() {
    let text = "range: 0.40\n---\nrange: 0.41\n---\nrange: 0.4";
    let (said, _, report) = said(text.as_bytes(), &Options::default());
    assert_eq!(said, "range: 0.4 0.41");
    assert_eq!(report.damage.len(), 1);
}

#[test]
fn lines_and_rows_of_one_sensor_each_show_the_firing_pattern() {
    let line = |n: u32| format!("12:00:{:02}.{:03} -> Sensor {}: 40 cm\n", n / 20, n % 20 * 50, n % 4 + 1);
    let row = |n: u32| {
        format!("{},{}40{}\n", f64::from(n) * 0.05, ",".repeat(n as usize % 4), ",".repeat(3 - n as usize % 4))
    };
    let lines: String = (0..400).map(line).collect();
    let rows = "t,a,b,c,d\n".to_owned() + &(0..400).map(row).collect::<String>();
    let at_once = "t,a,b,c,d\n".to_owned()
        + &(0..100).map(|n| format!("{},40,40,40,40\n", f64::from(n) * 0.2)).collect::<String>();
    for (text, expected) in [(lines, Pattern::InTurn), (rows, Pattern::InTurn), (at_once, Pattern::Unknown)] {
        assert_eq!(said(text.as_bytes(), &Options::default()).2.firing.pattern, expected, "{}", &text[..40]);
    }
}

#[test]
fn more_json_documents_give_the_same_records() {
    let expected = "left: 0.4 0.41; right: 0.8 -";
    for text in [
        "[{\"left\":40,\"right\":80},{\"left\":41,\"right\":null}]",
        "{\n\"ring\": \"a {[\",\n\"readings\": [{\"left\":40,\"right\":80},\n{\"left\":41,\"right\":null}]}",
        "{\"left\":40,\n\"right\":80}\n{\"left\":41,\n\"right\":null}\n",
        "{\"left\":40,\"right\":80}\n{\"left\":41,\"right\":null}\n",
    ] {
        assert_eq!(said(text.as_bytes(), &Options::default()).0, expected, "{text}");
    }
    let arrays = "column 1: 0.4 0.41; column 2: 0.8 -";
    for text in ["[[40,80],[41,null]]", "[40,80]\n[41,None]\n"] {
        assert_eq!(said(text.as_bytes(), &Options::default()).0, arrays, "{text}");
    }
}

#[test]
fn utf_16_and_packed_text_read_as_plain() {
    let text = "t,left,right\n0.0,40,80\n0.1,41,81\n";
    let expected = "left: 0.4 0.41; right: 0.8 0.81";
    for (bom, order) in [(true, true), (false, true), (true, false), (false, false)] {
        let start = if bom { "\u{feff}" } else { "" };
        let units = format!("{start}{text}").encode_utf16().collect::<Vec<_>>();
        let bytes: Vec<u8> =
            units.iter().flat_map(|unit| if order { unit.to_le_bytes() } else { unit.to_be_bytes() }).collect();
        assert_eq!(said(&bytes, &Options::default()).0, expected, "{bom} {order}");
    }
    let folder = tempfile::tempdir().unwrap();
    let mut gzip = flate2::write::GzEncoder::new(vec![], flate2::Compression::default());
    gzip.write_all(text.as_bytes()).unwrap();
    let mut bzip2 = bzip2::write::BzEncoder::new(vec![], bzip2::Compression::default());
    bzip2.write_all(text.as_bytes()).unwrap();
    let zstd = zstd::encode_all(text.as_bytes(), 1).unwrap();
    for (name, bytes) in [("a.csv.gz", gzip.finish().unwrap()), ("b.bz2", bzip2.finish().unwrap()), ("c.zst", zstd)] {
        let file = folder.path().join(name);
        std::fs::write(&file, &bytes).unwrap();
        let mut readings = 0;
        let report = read_log(&file, &Options::default(), |_, _| readings += 1).unwrap();
        assert_eq!((readings, report.names().join(" ").as_str(), report.damage.len()), (4, "left right", 0), "{name}");
        assert!(report.form.contains("packed by"), "{}", report.form);
        // Half a file says so.
        std::fs::write(&file, &bytes[..bytes.len() - 6]).unwrap();
        let report = read_log(&file, &Options::default(), |_, _| {}).unwrap();
        assert!(!report.damage.is_empty(), "{name}");
    }
    let bag = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bags/ros1-none.bag")).unwrap();
    let file = folder.path().join("drive.bag.zst");
    std::fs::write(&file, zstd::encode_all(&*bag, 1).unwrap()).unwrap();
    assert_eq!(read_log(&file, &Options::default(), |_, _| {}).unwrap().sensors.len(), 6);
}

#[test]
fn options_override_guesses() {
    let text = "a,b,c\n0,40,7\n1,41,7\n";
    let with = |change: &dyn Fn(&mut Options)| {
        let mut options = Options::default();
        change(&mut options);
        said(text.as_bytes(), &options).0
    };
    assert_eq!(with(&|options| options.table.ranges = vec!["b".to_owned()]), "b: 0.4 0.41");
    assert_eq!(
        with(&|options| options.table.columns = ["t", "near", "-"].map(str::to_owned).to_vec()),
        "near: 0.4 0.41"
    );
    let only = |options: &mut Options| options.table.ranges = vec!["a".to_owned()];
    let no_echo = |options: &mut Options| {
        only(options);
        options.no_echo = vec!["1".to_owned()];
        options.table.range_unit = Some(RangeUnit::M);
    };
    assert_eq!(with(&no_echo), "a: 0 -");
    let table = Table { columns: vec!["t".to_owned()], ..Table::default() };
    let refused = read_stream(text.as_bytes(), Path::new("log"), &Options { table, ..Options::default() }, |_, _| {});
    assert_eq!(refused.unwrap_err().message(), "--columns: 1 names; expected 3, as many as the rows have columns");
}

#[test]
fn log_without_sensors_says_what_it_holds() {
    for (text, expected) in [
        ("hello\nworld\n", "none of them a range"),
        ("t,battery\n1,12.1\n2,12.0\n", "columns t, battery, none of them a range"),
        ("{\"event\":\"start\"}\n", "columns event, none of them a range"),
        ("Time [s],Channel 0\n0.0000,0\n0.0012,1\n0.0052,0\n", "Channel 0, none of them a range"),
        ("can0 201 [4] 01 90 03 20\ncan0 201 [4] 01 91 03 21\ncan0 202 [4] 02 91 03 21\n", "none of them a range"),
        ("FMT, 128, 89, FMT, BBnNZ, Type,Length,Name\nATT, 100, 0.1, 0.2\n", "no records with ranges"),
    ] {
        let (_, _, report) = said(text.as_bytes(), &Options::default());
        assert!(report.sensors.is_empty());
        let said = report.skipped.last().unwrap().why.clone();
        assert!(said.contains(expected), "{text}: {said}");
    }
}

#[test]
fn foreign_forms_are_named_with_their_way_out() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes, form, way) in [
        ("a.ulg", &b"ULog\x01\x12\x35\x01"[..], "ULog", "pyulog"),
        ("a.csv.xz", b"\xfd7zXZ\0\0\x04", "packed by xz", "xz --decompress"),
        ("a.bin", b"\xa3\x95\x80\x80", "DataFlash", "pymavlink"),
        ("a.tlog", b"\0\x05\x12\x34\x56\x78\x9a\xbc\xfe\x09", "MAVLink", "pymavlink"),
        ("a.xlsx", b"PK\x03\x04", "spreadsheet", "read_excel"),
        ("a.dat", b"\x01\x02\x03\0\0\0\x07\x08", "binary", "MCAP"),
    ] {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let error = read_log(&file, &Options::default(), |_, _| {}).unwrap_err().to_string();
        assert!(error.contains(form) && error.contains(way) && !error.contains('\n'), "{error}");
        let error = eeruf_logs::FiringLog::read(&file).unwrap_err().to_string();
        assert!(error.contains(form), "{error}");
    }
}

/// A bag of the field cases.
fn bag(name: &str, options: &Options) -> (Report, Vec<Echo>) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/field-cases").join(name);
    let mut echoes = vec![];
    let report = read_log(&file, options, |_, reading| echoes.push(reading.echo())).unwrap();
    (report, echoes)
}

#[test]
fn points_arrays_and_long_scans_are_read_where_asked() {
    let topic = |topic: &str| Options { topics: vec![topic.to_owned()], ..Options::default() };
    let field = |topic: &str, path: &str, unit| Options {
        fields: vec![FieldChoice { topic: topic.to_owned(), path: path.to_owned(), unit }],
        ..Options::default()
    };
    let (points, _) = bag("pointcloud.bag", &Options::default());
    assert!(points.sensors.is_empty() && points.skipped[0].why.contains("--topic /RosAria/sonar"), "{points:?}");
    let (points, echoes) = bag("pointcloud.bag", &topic("/RosAria/sonar"));
    assert!(points.sensors.len() > 1 && !echoes.is_empty() && points.damage.is_empty(), "{points:?}");
    let (array, echoes) = bag("multiarray.bag", &Options::default());
    assert_eq!((array.sensors.len(), array.firing.pattern), (6, Pattern::Unknown));
    let mm = field("/ultrasonic", "data[]", RangeUnit::Mm);
    let (other, smaller) = bag("multiarray.bag", &mm);
    let range = |echo: &Echo| if let Echo::At(range_m) = echo { *range_m } else { f64::NAN };
    assert!((range(&smaller[0]) - range(&echoes[0]) * 1e-3).abs() < 1e-9 && other.sensors.len() == 6);
    let (wrong, _) = bag("multiarray.bag", &field("/ultrasonic", "ranges[]", RangeUnit::M));
    assert!(wrong.skipped[0].why.contains("no field `ranges[]`") && wrong.skipped[0].why.contains("data[]"));
    assert_eq!(bag("scan73.bag", &Options::default()).0.sensors.len(), 73);
    let (far, _) = bag("cmranges.bag", &Options::default());
    assert!(far.warnings[0].contains("--field /us range cm"), "{:?}", far.warnings);
    let (near, echoes) = bag("cmranges.bag", &field("/us", "range", RangeUnit::Cm));
    assert!(near.warnings.is_empty() && (range(&echoes[0]) - 0.8).abs() < 1e-6, "{:?}", echoes[0]);
}
