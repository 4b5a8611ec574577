//! Forms that programs in many languages give their logs, each with its right answer.

use crate::forms::Form;

/// Forms of programs in other languages, and of other habits.
pub(crate) const PROGRAMS: [Form; 41] = [
    (
        "ESPHome in colours, two sensors",
        "\u{1b}[0;36m[14:00:00][D][ultrasonic.sensor:040]: 'Left' - Got distance: 0.401 m\u{1b}[0m\n\
      \u{1b}[0;36m[14:00:00][D][sensor:126]: 'Left': Sending state 0.40112 m with 2 decimals of accuracy\u{1b}[0m\n\
      \u{1b}[0;36m[14:00:01][D][ultrasonic.sensor:040]: 'Right' - Got distance: 0.802 m\u{1b}[0m\n\
      \u{1b}[0;36m[14:00:01][D][sensor:126]: 'Right': Sending state 0.80212 m with 2 decimals of accuracy\u{1b}[0m\n\
      \u{1b}[0;36m[14:00:02][D][ultrasonic.sensor:036]: 'Left' - Distance measurement timed out!\u{1b}[0m\n\
      \u{1b}[0;36m[14:00:02][D][sensor:126]: 'Left': Sending state nan m with 2 decimals of accuracy\u{1b}[0m\n",
        "Left: 0.401 -; Right: 0.802",
        Some(2.0),
    ),
    (
        "ESPHome, A02YYUW and its level",
        "[12:00:00][D][a02yyuw.sensor:031]: Distance from sensor: 401 mm\n\
      [12:00:00][D][sensor:094]: 'Tank': Sending state 401.00000 mm with 0 decimals of accuracy\n\
      [12:00:00][D][sensor:094]: 'Level': Sending state 61.00000 % with 0 decimals of accuracy\n\
      [12:00:01][D][a02yyuw.sensor:031]: Distance from sensor: 402 mm\n\
      [12:00:01][D][sensor:094]: 'Tank': Sending state 402.00000 mm with 0 decimals of accuracy\n",
        "Tank: 0.401 0.402",
        Some(1.0),
    ),
    (
        "ESP32 before JSON lines",
        "ets Jun  8 2016 00:22:57\nrst:0x10 (RTCWDT_RTC_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\n\
      entry 0x400805f0\n{\"t\":0.0,\"front\":40}\n{\"t\":0.1,\"front\":41}\n",
        "front: 0.4 0.41",
        Some(0.1),
    ),
    (
        "Arduino's log of an ESP32",
        "[  1234][I][main.cpp:42] loop(): Distance: 40.1 cm\n\
      [  1294][I][main.cpp:42] loop(): Distance: 40.2 cm\n[  1354][I][main.cpp:42] loop(): Distance: 40.3 cm\n",
        "Distance: 0.401 0.402 0.403",
        Some(0.06),
    ),
    (
        "Zephyr",
        "*** Booting Zephyr OS build v3.5.0 ***\n[00:00:01.234,567] <inf> main: Distance: 40.1 cm\n\
      [00:00:01.294,567] <inf> main: Distance: 40.2 cm\n[00:00:01.354,567] <inf> main: Distance: 40.3 cm\n",
        "Distance: 0.401 0.402 0.403",
        Some(0.06),
    ),
    (
        "RIOT",
        "2026-01-01 14:00:00,100 # Distance: 401 mm\n2026-01-01 14:00:00,160 # Distance: 402 mm\n\
      2026-01-01 14:00:00,220 # Distance: 403 mm\n",
        "Distance: 0.401 0.402 0.403",
        Some(0.06),
    ),
    (
        "mbed",
        "Distance changed to 401mm\nDistance changed to 402mm\nDistance changed to 1403mm\n",
        "Distance changed to: 0.401 0.402 1.403",
        None,
    ),
    ("Tinkercad", "40cm\n41cm\n40cm\n0cm\n42cm\n", "column 1: 0.4 0.41 0.4 - 0.42", None),
    (
        "a German spreadsheet",
        "Zeit\tAbstand (cm)\n14:00:00,100\t40,1\n14:00:00,160\t40,2\n14:00:00,220\t40,1\n",
        "Abstand (cm): 0.401 0.402 0.401",
        Some(0.06),
    ),
    (
        "two in German",
        "Zeit;Entfernung links [cm];Entfernung rechts [cm]\n0,00;40,1;80,2\n0,06;40,2;80,3\n",
        "Entfernung links [cm]: 0.401 0.402; Entfernung rechts [cm]: 0.802 0.803",
        Some(0.06),
    ),
    (
        "a colon of full width",
        "\u{8ddd}\u{79bb}\u{ff1a}40.1 cm\n\u{8ddd}\u{79bb}\u{ff1a}40.2 cm\n",
        "\u{8ddd}\u{79bb}: 0.401 0.402",
        None,
    ),
    ("a colon after a space", "Distance : 40 cm\nDistance : 41 cm\n", "Distance: 0.4 0.41", None),
    ("letters for names", "t=1234 d=40\nt=1294 d=41\nt=1354 d=40\n", "d: 0.4 0.41 0.4", Some(0.06)),
    (
        "bars between pairs",
        "F: 40 cm | L: 80 cm | R: ---\nF: 41 cm | L: 81 cm | R: 120 cm\n",
        "F: 0.4 0.41; L: 0.8 0.81; R: - 1.2",
        None,
    ),
    (
        "frames",
        "--------------\nSensor 1: 40cm\nSensor 2: 80cm\n--------------\nSensor 1: 41cm\nSensor 2: 81cm\n\
      --------------\n",
        "Sensor 1: 0.4 0.41; Sensor 2: 0.8 0.81",
        None,
    ),
    ("zeroes before", "S1:040;S2:080;\nS1:041;S2:081;\n", "S1: 0.4 0.41; S2: 0.8 0.81", None),
    (
        "ThingSpeak's feed",
        "{\"channel\":{\"id\":12,\"name\":\"ring\",\"field1\":\"front\",\"last_entry_id\":2},\"feeds\":[\
      {\"created_at\":\"2026-01-01T14:00:00Z\",\"entry_id\":1,\"field1\":\"40.1\"},\
      {\"created_at\":\"2026-01-01T14:00:15Z\",\"entry_id\":2,\"field1\":\"40.2\"}]}",
        "field1: 0.401 0.402",
        Some(15.0),
    ),
    ("collectd", "epoch,value\n1700000000.000,40.1\n1700000010.000,40.2\n", "value: 0.401 0.402", Some(10.0)),
    (
        "InfluxDB's client",
        "name: sonar\ntime                distance sensor\n----                -------- ------\n\
      1700000000000000000 40.1     front\n1700000000030000000 80.2     back\n1700000000060000000 40.2     front\n",
        "front: 0.401 0.402; back: 0.802",
        Some(0.06),
    ),
    (
        "InfluxDB's client, CSV",
        "name,time,distance,sensor\nsonar,1700000000000000000,40.1,front\n\
      sonar,1700000000030000000,80.2,back\nsonar,1700000000060000000,40.2,front\n",
        "front: 0.401 0.402; back: 0.802",
        Some(0.06),
    ),
    (
        "Timescale",
        "time,sensor_id,distance_cm\n2026-01-01 14:00:00.10+00,1,40.1\n2026-01-01 14:00:00.13+00,2,80.2\n\
      2026-01-01 14:00:00.16+00,1,40.2\n",
        "1: 0.401 0.402; 2: 0.802",
        Some(0.06),
    ),
    (
        "MySQL",
        "+------+-------+------+\n| t    | front | back |\n+------+-------+------+\n|  0.0 |  40.1 | 80.2 |\n\
      |  0.1 |  40.2 | NULL |\n+------+-------+------+\n2 rows in set (0.00 sec)\n",
        "front: 0.401 0.402; back: 0.802 -",
        Some(0.1),
    ),
    (
        "MongoDB",
        "{\"_id\":{\"$oid\":\"65a0\"},\"t\":{\"$date\":\"2026-01-01T14:00:00.00Z\"},\"front\":40.1}\n\
      {\"_id\":{\"$oid\":\"65a1\"},\"t\":{\"$date\":\"2026-01-01T14:00:00.06Z\"},\"front\":40.2}\n",
        "front: 0.401 0.402",
        Some(0.06),
    ),
    (
        "Kibana",
        "\"@timestamp\",sensor,distance\n\"Jan 1, 2026 @ 14:00:00.100\",front,40.1\n\
      \"Jan 1, 2026 @ 14:00:00.130\",back,80.2\n\"Jan 1, 2026 @ 14:00:00.160\",front,40.2\n",
        "front: 0.401 0.402; back: 0.802",
        Some(0.06),
    ),
    (
        "Particle",
        "{\"data\":\"40.1\",\"ttl\":60,\"published_at\":\"2026-01-01T14:00:00.100Z\",\"coreid\":\"e00f\",\"nam\
         e\":\"front\"}\n\
      {\"data\":\"80.2\",\"ttl\":60,\"published_at\":\"2026-01-01T14:00:00.130Z\",\"coreid\":\"e00f\",\"name\"\
         :\"back\"}\n\
      {\"data\":\"40.2\",\"ttl\":60,\"published_at\":\"2026-01-01T14:00:00.160Z\",\"coreid\":\"e00f\",\"name\"\
         :\"front\"}\n",
        "front: 0.401 0.402; back: 0.802",
        Some(0.06),
    ),
    (
        "Python's clock",
        "1700000000.1234567 40.1\n1700000000.1834567 40.2\n1700000000.2434567 40.1\n",
        "column 2: 0.401 0.402 0.401",
        Some(0.06),
    ),
    (
        "Python's date",
        "2026-01-01 14:00:00.123456 40.1 80.2\n2026-01-01 14:00:00.183456 40.2 80.3\n\
      2026-01-01 14:00:00.243456 40.1 80.2\n",
        "column 1: 0.401 0.402 0.401; column 2: 0.802 0.803 0.802",
        Some(0.06),
    ),
    (
        "Flask",
        "[2026-01-01 14:00:00,100] INFO in app: front=40.1\n[2026-01-01 14:00:00,160] INFO in app: front=40.2\n",
        "front: 0.401 0.402",
        Some(0.06),
    ),
    (
        "loguru",
        "2026-01-01 14:00:00.100 | INFO     | __main__:loop:12 - front: 40.1 cm\n\
      2026-01-01 14:00:00.160 | INFO     | __main__:loop:12 - front: 40.2 cm\n\
      2026-01-01 14:00:00.220 | INFO     | __main__:loop:12 - front: 40.1 cm\n",
        "front: 0.401 0.402 0.401",
        Some(0.06),
    ),
    (
        "env_logger",
        "[2026-01-01T14:00:00.100Z INFO  sonar] front: 40.1 cm\n[2026-01-01T14:00:00.160Z INFO  sonar] front: 40\
         .2 cm\n",
        "front: 0.401 0.402",
        Some(0.06),
    ),
    (
        "tracing",
        "2026-01-01T14:00:00.100000Z  INFO sonar: range front=40.1 back=80.2\n\
      2026-01-01T14:00:00.160000Z  INFO sonar: range front=40.2 back=80.3\n",
        "front: 0.401 0.402; back: 0.802 0.803",
        Some(0.06),
    ),
    (
        "slog",
        "time=2026-01-01T14:00:00.100Z level=INFO msg=range front=40.1 back=80.2\n\
      time=2026-01-01T14:00:00.160Z level=INFO msg=range front=40.2 back=80.3\n",
        "front: 0.401 0.402; back: 0.802 0.803",
        Some(0.06),
    ),
    ("Go's log", "2026/01/01 14:00:00 front: 40.1\n2026/01/01 14:00:01 front: 40.2\n", "front: 0.401 0.402", Some(1.0)),
    (
        "log4j",
        "2026-01-01 14:00:00,100 INFO  [main] Sonar - front: 40.1\n2026-01-01 14:00:00,160 INFO  [main] Sona\
         r - front: 40.2\n",
        "front: 0.401 0.402",
        Some(0.06),
    ),
    (
        "logcat",
        "01-01 14:00:00.100  1234  5678 D Sonar   : front: 40.1\n01-01 14:00:00.160  1234  5678 D Sonar   : fron\
         t: 40.2\n",
        "front: 0.401 0.402",
        Some(0.06),
    ),
    ("dmesg", "[  123.100000] sonar: front=40.1\n[  123.160000] sonar: front=40.2\n", "front: 0.401 0.402", Some(0.06)),
    (
        "pino",
        "{\"level\":30,\"time\":1700000000000,\"pid\":7,\"hostname\":\"pi\",\"msg\":\"front: 40.1 cm\"}\n\
      {\"level\":30,\"time\":1700000000060,\"pid\":7,\"hostname\":\"pi\",\"msg\":\"front: 40.2 cm\"}\n",
        "front: 0.401 0.402",
        Some(0.06),
    ),
    (
        "structlog",
        "{\"event\":\"range\",\"sensor\":\"front\",\"distance_cm\":40.1,\"timestamp\":\"2026-01-01T14:00:00.100\
         Z\",\"level\":\"info\"}\n\
      {\"event\":\"range\",\"sensor\":\"back\",\"distance_cm\":80.2,\"timestamp\":\"2026-01-01T14:00:00.130Z\"\
         ,\"level\":\"info\"}\n\
      {\"event\":\"range\",\"sensor\":\"front\",\"distance_cm\":40.2,\"timestamp\":\"2026-01-01T14:00:00.160Z\"\
         ,\"level\":\"info\"}\n",
        "front: 0.401 0.402; back: 0.802",
        Some(0.06),
    ),
    (
        "YAML below a key, with nested values",
        "readings:\n  - stamp: 0.0\n    ring:\n      front: 0.4\n      back: 0.8\n\
      \x20 - stamp: 0.05\n    ring:\n      front: 0.41\n      back: .nan\n",
        "ring.front: 0.4 0.41; ring.back: 0.8 -",
        Some(0.05),
    ),
    (
        "a spreadsheet's days every five minutes",
        "Date/Time,Level (cm)\n45234.500000,40.1\n45234.503472,40.2\n45234.506944,40.3\n",
        "Level (cm): 0.401 0.402 0.403",
        Some(299.9808),
    ),
    (
        "a voltage and a range",
        "time,voltage_v,raw,distance_cm\n0.0,0.98,201,40.1\n0.1,1.25,256,51.2\n0.2,1.69,346,69.3\n",
        "distance_cm: 0.401 0.512 0.693",
        Some(0.1),
    ),
];
