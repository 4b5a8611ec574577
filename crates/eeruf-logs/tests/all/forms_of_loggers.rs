//! More forms of loggers, boards, buses and databases, each with its right answer.

use eeruf_logs::{Options, Table};

use crate::forms::{Form, said};
use crate::forms_of_programs::PROGRAMS;

/// Forms of a board and its libraries.
const BOARDS: [Form; 32] = [
    (
        "ESPHome",
        "[14:49:45][C][ultrasonic.sensor:049]: Ultrasonic Sensor 'Front'\n\
         [14:49:45][C][ultrasonic.sensor:050]:   Echo Pin: GPIO4\n\
         [14:49:46][D][ultrasonic.sensor:040]: 'Front' - Got distance: 1.52 m\n\
         [14:49:46][D][sensor:126]: 'Front': Sending state 1.52258 m with 2 decimals of accuracy\n\
         [14:49:56][D][ultrasonic.sensor:040]: 'Front' - Got distance: 0.76 m\n\
         [14:49:56][D][sensor:126]: 'Front': Sending state 0.75717 m with 2 decimals of accuracy\n",
        "Front: 1.52 0.76",
        Some(10.0),
    ),
    (
        "ESPHome of today, with a timeout and other sensors",
        "INFO ESPHome 2026.2.0\n\
         INFO Starting log output from 192.168.1.7 using esphome API\n\
         [11:07:22.900][V][ultrasonic.sensor:055]: Echo took 8650us\n\
         [11:07:22.912][D][ultrasonic.sensor:057]: 'Back yard' - Got distance: 1.483 m\n\
         [11:07:22.912][V][sensor:083]: 'Back yard': Received new state 1.483475\n\
         [11:07:22.912][D][sensor:135]: 'Back yard': Sending state 1.48348 m with 1 decimals of accuracy\n\
         [11:07:23.002][D][sensor:135]: 'WiFi': Sending state -64.00000 dBm with 0 decimals of accuracy\n\
         [11:07:32.912][D][ultrasonic.sensor:065]: 'Back yard' - Measurement start timed out after 60012us\n\
         [11:07:32.912][D][sensor:135]: 'Back yard': Sending state nan m with 1 decimals of accuracy\n\
         [11:07:42.912][D][ultrasonic.sensor:057]: 'Back yard' - Got distance: 1.485 m\n\
         [11:07:42.912][D][sensor:135]: 'Back yard': Sending state 1.48510 m with 1 decimals of accuracy\n",
        "Back yard: 1.483 - 1.485",
        Some(10.0),
    ),
    (
        "ESPHome, a timeout without a name",
        "[12:00:00][D][ultrasonic.sensor:036]: 'Front' - Got distance: 1.23 m\n\
         [12:00:00][D][sensor:094]: 'Front': Sending state 1.23400 m with 2 decimals of accuracy\n\
         [12:00:01][D][ultrasonic.sensor:033]: Distance measurement timed out!\n\
         [12:00:01][D][sensor:094]: 'Front': Sending state nan m with 2 decimals of accuracy\n\
         [12:00:02][D][ultrasonic.sensor:036]: 'Front' - Got distance: 1.24 m\n\
         [12:00:02][D][sensor:094]: 'Front': Sending state 1.24100 m with 2 decimals of accuracy\n",
        "Front: 1.23 - 1.24",
        Some(1.0),
    ),
    (
        "ESPHome, states alone, as of a sensor on a serial line, without times",
        "[D][sensor:094]: 'Tank': Sending state 412.00000 mm with 0 decimals of accuracy\n\
         [D][sensor:094]: 'Pump': Sending state 23.10000 W with 1 decimals of accuracy\n\
         [D][sensor:094]: 'Tank': Sending state 413.00000 mm with 0 decimals of accuracy\n",
        "Tank: 0.412 0.413",
        None,
    ),
    (
        "ESP32, its start and a reset",
        "ets Jul 29 2019 12:21:46\n\nrst:0x1 (POWERON_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\n\
         configsip: 0, SPIWP:0xee\n\
         clk_drv:0x00,q_drv:0x00,d_drv:0x00,cs0_drv:0x00,hd_drv:0x00,wp_drv:0x00\n\
         mode:DIO, clock div:1\nload:0x3fff0030,len:1344\nload:0x40078000,len:13964\n\
         ho 0 tail 12 room 4\nload:0x40080400,len:3600\nentry 0x400805f0\n\
         Distance: 40 cm\nDistance: 41 cm\n\
         Guru Meditation Error: Core  1 panic'ed (LoadProhibited). Exception was unhandled.\n\n\
         Core  1 register dump:\n\
         PC      : 0x400d1234  PS      : 0x00060730  A0      : 0x800d2345  A1      : 0x3ffb1f90  \n\
         EXCVADDR: 0x00000000  LBEG    : 0x400d1000  LEND    : 0x400d1010  LCOUNT  : 0x00000000  \n\n\
         Backtrace: 0x400d1231:0x3ffb1f90 0x400d2342:0x3ffb1fb0\n\n\
         ELF file SHA256: 0000000000000000\n\nRebooting...\n\
         ets Jul 29 2019 12:21:46\n\nrst:0xc (SW_CPU_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\n\
         configsip: 0, SPIWP:0xee\nentry 0x400805f0\nDistance: 40 cm\n",
        "Distance: 0.4 0.41 0.4",
        None,
    ),
    (
        "ESP32-S3 before a table",
        "ESP-ROM:esp32s3-20210327\nBuild:Mar 27 2021\nrst:0x1 (POWERON),boot:0x8 (SPI_FAST_FLASH_BOOT)\n\
         SPIWP:0xee\nmode:DIO, clock div:1\nload:0x3fce3808,len:0x4bc\nload:0x403c9700,len:0xbd8\n\
         entry 0x403c98d0\nfront,back\n40,80\n41,81\n",
        "front: 0.4 0.41; back: 0.8 0.81",
        None,
    ),
    (
        "ESP-IDF, its start",
        "I (29) boot: ESP-IDF v5.1.2 2nd stage bootloader\nI (29) boot: compile time Jan  2 2024 12:00:00\n\
         I (46) boot: ## Label            Usage          Type ST Offset   Length\n\
         I (53) boot:  0 nvs              WiFi data        01 02 00009000 00006000\n\
         I (301) cpu_start: Pro cpu up.\nI (319) heap_init: At 3FFAE6E0 len 00001920 (6 KiB): DRAM\n\
         I (330) gpio: GPIO[5]| InputEn: 0| OutputEn: 1| OpenDrain: 0| Pullup: 0| Pulldown: 0| Intr:0 \n\
         I (400) main_task: Calling app_main()\nI (500) sonar: Distance: 40 cm\nI (560) sonar: Distance: 41 cm\n",
        "Distance: 0.4 0.41",
        Some(0.06),
    ),
    (
        "ESP8266, an exception",
        "front: 40 cm\nfront: 41 cm\n\nException (28):\n\
         epc1=0x40201234 epc2=0x00000000 epc3=0x00000000 excvaddr=0x00000000 depc=0x00000000\n\n\
         >>>stack>>>\n\nctx: cont\nsp: 3ffffdc0 end: 3fffffc0 offset: 0190\n\
         3fffff50:  3ffe84c8 00000020 3ffee520 40202345  \n<<<stack<<<\n\n\
          ets Jan  8 2013,rst cause:2, boot mode:(3,6)\n\nload 0x4010f000, len 3460, room 16 \ntail 4\nchksum 0xcc\n\
         load 0x3fff20b8, len 40, room 4 \ntail 4\nchksum 0xc9\ncsum 0xc9\nv00074f70\n~ld\nfront: 40 cm\n",
        "front: 0.4 0.41 0.4",
        None,
    ),
    (
        "noise of a board's start at another baud rate",
        "\u{fffd}\u{1}\u{fffd}\u{fffd}l\u{fffd}\u{0}\u{fffd}|\u{fffd}\u{3}\u{fffd}\u{fffd}\nfront: 40 cm\nfront\
         : 41 cm\n",
        "front: 0.4 0.41",
        None,
    ),
    (
        "Arduino's Ping",
        "15in, 40cm\n20in, 51cm\n27in, 69cm\n31in, 80cm\n16in, 42cm\n",
        "column 2: 0.4 0.51 0.69 0.8 0.42",
        None,
    ),
    (
        "centimetres and inches on lines of their own",
        "Distance (cm): 40.12\nDistance (inch): 15.80\nDistance (cm): 51.40\nDistance (inch): 20.24\n\
         Distance (cm): 69.05\nDistance (inch): 27.19\n",
        "Distance (cm): 0.401 0.514 0.691",
        None,
    ),
    (
        "Grove",
        "The distance to obstacles in front is: \n15 inch\n40 cm\nThe distance to obstacles in front is: \n20 inch\n\
         51 cm\nThe distance to obstacles in front is: \n27 inch\n69 cm\n",
        "The distance to obstacles in front is: 0.4 0.51 0.69",
        None,
    ),
    (
        "US-100 with its temperature",
        "Present Length is: 401mm\nPresent Temperature is: 21 degree Celsius.\n\
         Present Length is: 402mm\nPresent Temperature is: 21 degree Celsius.\n",
        "Present Length is: 0.401 0.402",
        None,
    ),
    (
        "A02YYUW",
        "distance=40.1cm\nBelow the lower limit\ndistance=40.3cm\nERROR\ndistance=40.2cm\n",
        "distance: 0.401 0.403 0.402",
        None,
    ),
    (
        "MaxBotix, its start",
        "HRXL-MaxSonar-WR\rPN:MB7389\rCopyright 2011-2015\rMaxBotix Inc.\rRoHS 1.8b094  0316\rTempI\r\
         R0756\rR0757\rR5000\rR0756\rR0757\r",
        "R: 0.756 0.757 - 0.756 0.757",
        None,
    ),
    (
        "echo time and range",
        "Duration: 2332 us, Distance: 40.0 cm\nDuration: 2973 us, Distance: 51.0 cm\n\
      Duration: 4023 us, Distance: 69.0 cm\nDuration: 2448 us, Distance: 42.0 cm\n",
        "Duration: 0.4 0.51 0.69 0.42",
        None,
    ),
    (
        "MicroPython",
        "MPY: soft reboot\nDistance: 40.1 cm\nDistance: 40.2 cm\nDistance: 40.3 cm\n",
        "Distance: 0.401 0.402 0.403",
        None,
    ),
    (
        "CircuitPython's tuples",
        "Auto-reload is on. Simply save files over USB to run them or enter REPL to disable.\ncode.py output:\n\
         (40.1,)\n(40.2,)\nRetrying!\n(40.3,)\n",
        "column 1: 0.401 0.402 0.403",
        None,
    ),
    (
        "gpiozero",
        "Distance to nearest object is 0.4012345678901234 m\nDistance to nearest object is 0.5101 m\n\
      Distance to nearest object is 1.0 m\n",
        "Distance to nearest object is: 0.401 0.51 1",
        None,
    ),
    (
        "a tutorial of the Raspberry Pi",
        "Measured Distance = 40.1 cm\nMeasured Distance = 40.2 cm\n\
      Measurement stopped by User\n",
        "Measured Distance: 0.401 0.402",
        None,
    ),
    (
        "another tutorial",
        "Distance Measurement In Progress\nWaiting For Sensor To Settle\nDistance: 40.1 cm\n\
      Distance: 40.21 cm\n",
        "Distance: 0.401 0.402",
        None,
    ),
    (
        "axes of a plotter",
        "Min:0,Max:400,front:40,back:80\nMin:0,Max:400,front:41,back:81\n\
      Min:0,Max:400,front:40,back:82\n",
        "front: 0.4 0.41 0.4; back: 0.8 0.81 0.82",
        None,
    ),
    ("Teleplot", ">front:40.1\n>back:80.2\n>front:40.2\n>back:80.3\n", "front: 0.401 0.402; back: 0.802 0.803", None),
    (
        "Teleplot with times and a unit",
        ">front:1627551892437:40.1\u{a7}cm\n>front:1627551892487:40.2\u{a7}cm\n>front:1627551892537:40.3\u{a7}cm\n",
        "front: 0.401 0.402 0.403",
        Some(0.05),
    ),
    (
        "PlatformIO's monitor",
        "--- Terminal on /dev/ttyUSB0 | 115200 8-N-1\n\
         --- Available filters and text transformations: colorize, debug, default, direct, time\n\
         --- More details at https://bit.ly/pio-monitor-filters\n--- Quit: Ctrl+C | Menu: Ctrl+T | Help: Ctrl+T\n\
         14:00:00.100 > Distance: 40 cm\n14:00:00.160 > Distance: 41 cm\n14:00:00.220 > Distance: 40 cm\n",
        "Distance: 0.4 0.41 0.4",
        Some(0.06),
    ),
    (
        "PuTTY",
        "=~=~=~=~=~=~=~=~=~=~=~= PuTTY log 2026.01.01 14:00:00 =~=~=~=~=~=~=~=~=~=~=~=\n40,80\n41,81\n40,80\n",
        "column 1: 0.4 0.41 0.4; column 2: 0.8 0.81 0.8",
        None,
    ),
    ("inches beside centimetres", "t,cm,inch\n0.0,40,15.7\n0.1,51,20.1\n0.2,69,27.2\n", "cm: 0.4 0.51 0.69", Some(0.1)),
    (
        "millimetres beside metres",
        "front_m,front_mm\n0.401,401\n0.512,512\n0.690,690\n",
        "front_m: 0.401 0.512 0.69",
        None,
    ),
    (
        "converter beside the range",
        "t,adc,distance\n0.0,212,40\n0.1,300,51\n0.2,411,69\n",
        "distance: 0.4 0.51 0.69",
        Some(0.1),
    ),
    (
        "converter by its pin",
        "A0: 212\tDistance: 40 cm\nA0: 300\tDistance: 51 cm\nA0: 411\tDistance: 69 cm\n",
        "Distance: 0.4 0.51 0.69",
        None,
    ),
    ("raw and filtered", "raw,filtered\n40,40.0\n51,42.2\n69,47.6\n40,46.0\n", "raw: 0.4 0.51 0.69 0.4", None),
    (
        "a copy",
        "front,front_copy\n40,40\n51,51\n69,69\n40,40\n44,44\n80,80\n85,85\n90,90\n",
        "front: 0.4 0.51 0.69 0.4 0.44 0.8 0.85 0.9",
        None,
    ),
];

/// Forms of loggers, databases and buses.
const LOGGERS: [Form; 37] = [
    (
        "mosquitto_sub -v",
        "ring/front 40.1\nring/back 80.2\nring/front 40.2\nring/back 80.3\n",
        "ring/front: 0.401 0.402; ring/back: 0.802 0.803",
        None,
    ),
    (
        "mosquitto_sub -F '%I %t %p'",
        "2026-01-01T14:00:00+0100 ring/front 40.1\n2026-01-01T14:00:00+0100 ring/back 80.2\n\
      2026-01-01T14:00:01+0100 ring/front 40.2\n2026-01-01T14:00:01+0100 ring/back 80.3\n",
        "ring/front: 0.401 0.402; ring/back: 0.802 0.803",
        Some(1.0),
    ),
    (
        "mosquitto_sub -v with objects",
        "ring/front {\"distance\":40.1,\"t\":0.0}\nring/back {\"distance\":80.2,\"t\":0.1}\n\
      ring/front {\"distance\":40.2,\"t\":0.2}\nring/back {\"distance\":80.3,\"t\":0.3}\n",
        "ring/front: 0.401 0.402; ring/back: 0.802 0.803",
        Some(0.2),
    ),
    (
        "Tasmota",
        "14:00:00.123 MQT: tele/front/SENSOR = {\"Time\":\"2026-01-01T14:00:00\",\"SR04\":{\"Distance\":40.1}}\n\
      14:00:10.123 MQT: tele/front/SENSOR = {\"Time\":\"2026-01-01T14:00:10\",\"SR04\":{\"Distance\":40.2}}\n\
      14:00:20.123 MQT: tele/front/SENSOR = {\"Time\":\"2026-01-01T14:00:20\",\"SR04\":{\"Distance\":40.3}}\n",
        "MQT: tele/front/SENSOR: 0.401 0.402 0.403",
        Some(10.0),
    ),
    (
        "Node-RED",
        "{\"topic\":\"ring/front\",\"payload\":40.1,\"_msgid\":\"a1b2\"}\n\
      {\"topic\":\"ring/back\",\"payload\":80.2,\"_msgid\":\"a1b3\"}\n\
      {\"topic\":\"ring/front\",\"payload\":40.2,\"_msgid\":\"a1b4\"}\n",
        "ring/front: 0.401 0.402; ring/back: 0.802",
        None,
    ),
    (
        "InfluxDB's lines",
        "sonar,host=pi,sensor=front distance=40.1 1700000000000000000\n\
      sonar,host=pi,sensor=back distance=80.2 1700000000030000000\n\
      sonar,host=pi,sensor=front distance=40.2 1700000000060000000\n",
        "front: 0.401 0.402; back: 0.802",
        Some(0.06),
    ),
    (
        "InfluxDB's lines, a field each",
        "ring front=40.1,back=80.2 1700000000000000000\n\
      ring front=40.2,back=80.3 1700000000060000000\n",
        "front: 0.401 0.402; back: 0.802 0.803",
        Some(0.06),
    ),
    (
        "InfluxDB's annotated CSV, two tables",
        "#group,false,false,true,true,false,false,true,true\r\n\
      #datatype,string,long,dateTime:RFC3339,dateTime:RFC3339,dateTime:RFC3339,double,string,string\r\n\
      #default,_result,,,,,,,\r\n,result,table,_start,_stop,_time,_value,_field,_measurement\r\n\
      ,,0,2026-01-01T00:00:00Z,2026-01-02T00:00:00Z,2026-01-01T14:00:00.00Z,40.1,front,ring\r\n\
      ,,0,2026-01-01T00:00:00Z,2026-01-02T00:00:00Z,2026-01-01T14:00:00.06Z,40.2,front,ring\r\n\r\n\
      #group,false,false,true,true,false,false,true,true\r\n\
      #datatype,string,long,dateTime:RFC3339,dateTime:RFC3339,dateTime:RFC3339,double,string,string\r\n\
      #default,_result,,,,,,,\r\n,result,table,_start,_stop,_time,_value,_field,_measurement\r\n\
      ,,1,2026-01-01T00:00:00Z,2026-01-02T00:00:00Z,2026-01-01T14:00:00.03Z,80.2,back,ring\r\n\
      ,,1,2026-01-01T00:00:00Z,2026-01-02T00:00:00Z,2026-01-01T14:00:00.09Z,80.3,back,ring\r\n",
        "front: 0.401 0.402; back: 0.802 0.803",
        Some(0.06),
    ),
    (
        "Telegraf",
        "{\"fields\":{\"distance\":40.1},\"name\":\"sonar\",\"tags\":{\"host\":\"pi\",\"sensor\":\"front\"},\"ti\
         mestamp\":1700000000}\n\
      {\"fields\":{\"distance\":80.2},\"name\":\"sonar\",\"tags\":{\"host\":\"pi\",\"sensor\":\"back\"},\"timest\
         amp\":1700000000}\n\
      {\"fields\":{\"distance\":40.2},\"name\":\"sonar\",\"tags\":{\"host\":\"pi\",\"sensor\":\"front\"},\"times\
         tamp\":1700000001}\n",
        "front: 0.401 0.402; back: 0.802",
        Some(1.0),
    ),
    (
        "Prometheus",
        "# HELP sonar_distance_meters Range.\n# TYPE sonar_distance_meters gauge\n\
      sonar_distance_meters{sensor=\"front\"} 0.401 1700000000000\nsonar_distance_meters{sensor=\"back\"} 0.80\
         2 1700000000000\n\
      sonar_distance_meters{sensor=\"front\"} 0.402 1700000001000\nsonar_distance_meters{sensor=\"back\"} 0.80\
         3 1700000001000\n",
        "front: 0.401 0.402; back: 0.802 0.803",
        Some(1.0),
    ),
    (
        "Graphite",
        "ring.front 40.1 1700000000\nring.back 80.2 1700000000\nring.front 40.2 1700000001\n\
      ring.back 80.3 1700000001\n",
        "ring.front: 0.401 0.402; ring.back: 0.802 0.803",
        Some(1.0),
    ),
    (
        "Home Assistant, unknown",
        "entity_id,state,last_changed\nsensor.front,40.1,2026-01-01T14:00:00.000Z\n\
      sensor.front,unknown,2026-01-01T14:00:01.000Z\nsensor.front,40.2,2026-01-01T14:00:02.000Z\n",
        "sensor.front: 0.401 - 0.402",
        Some(1.0),
    ),
    (
        "Grafana",
        "\"Time\",\"front\",\"back\"\n\"2026-01-01 14:00:00.000\",\"40.1 cm\",\"80.2 cm\"\n\
      \"2026-01-01 14:00:00.050\",\"40.2 cm\",\"80.3 cm\"\n",
        "front: 0.401 0.402; back: 0.802 0.803",
        Some(0.05),
    ),
    (
        "QGroundControl",
        "Timestamp,roll,altitudeRelative,distanceSensor.rotationNone,distanceSensor.rotationPitch270\n\
      2026-01-01 14:00:00.100,0.1,10.0,1.23,2.50\n2026-01-01 14:00:00.200,0.2,10.1,--.--,2.51\n\
      2026-01-01 14:00:00.300,0.1,10.1,1.24,2.50\n",
        "distanceSensor.rotationNone: 1.23 - 1.24; distanceSensor.rotationPitch270: 2.5 2.51 2.5",
        Some(0.1),
    ),
    (
        "Octave",
        "# Created by Octave 8.4.0, Thu Jan 01 14:00:00 2026 UTC <me@pi>\n# name: run\n# type: matrix\n# rows: 3\n\
      # columns: 2\n 0 40.1\n 0.05 40.2\n 0.1 40.3\n\n\n",
        "column 2: 0.401 0.402 0.403",
        Some(0.05),
    ),
    (
        "candump -L",
        "(1700000000.123456) can0 201#01900320\n(1700000000.173456) can0 201#01910321\n\
      (1700000000.223456) can0 201#01920322\n",
        "",
        None,
    ),
    (
        "journalctl -o json",
        "{\"__REALTIME_TIMESTAMP\":\"1700000000000000\",\"MESSAGE\":\"front: 40.1 cm\",\"_PID\":\"7\"}\n\
      {\"__REALTIME_TIMESTAMP\":\"1700000000050000\",\"MESSAGE\":\"front: 40.2 cm\",\"_PID\":\"7\"}\n",
        "front: 0.401 0.402",
        Some(0.05),
    ),
    (
        "docker's file",
        "{\"log\":\"front: 40.1 cm\\n\",\"stream\":\"stdout\",\"time\":\"2026-01-01T14:00:00.000000000Z\"}\n\
      {\"log\":\"front: 40.2 cm\\n\",\"stream\":\"stdout\",\"time\":\"2026-01-01T14:00:00.050000000Z\"}\n",
        "front: 0.401 0.402",
        Some(0.05),
    ),
    (
        "docker logs -t",
        "2026-01-01T14:00:00.000000000Z front: 40.1 cm\n2026-01-01T14:00:00.050000000Z front: 40.2 cm\n",
        "front: 0.401 0.402",
        Some(0.05),
    ),
    (
        "docker compose logs",
        "sonar-1  | front: 40.1 cm\nsonar-1  | front: 40.2 cm\nsonar-1  | front: 40.3 cm\n",
        "front: 0.401 0.402 0.403",
        None,
    ),
    (
        "The Things Network",
        "{\"end_device_ids\":{\"device_id\":\"tank\"},\"received_at\":\"2026-01-01T14:00:00Z\",\
      \"uplink_message\":{\"f_port\":1,\"f_cnt\":7,\"frm_payload\":\"AZE=\",\"decoded_payload\":{\"distance\":401},\
      \"rx_metadata\":[{\"rssi\":-60,\"snr\":9.2}]}}\n\
      {\"end_device_ids\":{\"device_id\":\"tank\"},\"received_at\":\"2026-01-01T14:01:00Z\",\
      \"uplink_message\":{\"f_port\":1,\"f_cnt\":8,\"frm_payload\":\"AZM=\",\"decoded_payload\":{\"distance\":403},\
      \"rx_metadata\":[{\"rssi\":-61,\"snr\":9.0}]}}\n\
      {\"end_device_ids\":{\"device_id\":\"tank\"},\"received_at\":\"2026-01-01T14:02:00Z\",\
      \"uplink_message\":{\"f_port\":1,\"f_cnt\":9,\"frm_payload\":\"Ao0=\",\"decoded_payload\":{\"distance\":1653},\
      \"rx_metadata\":[{\"rssi\":-61,\"snr\":9.0}]}}\n",
        "tank: 0.401 0.403 1.653",
        Some(60.0),
    ),
    (
        "Firebase",
        "{\"-NaBcDeFgHiJkLmNoPq1\":{\"distance\":40.1,\"timestamp\":1700000000000},\n\
      \"-NaBcDeFgHiJkLmNoPq2\":{\"distance\":40.2,\"timestamp\":1700000000050},\n\
      \"-NaBcDeFgHiJkLmNoPq3\":{\"distance\":40.3,\"timestamp\":1700000000100}}\n",
        "distance: 0.401 0.402 0.403",
        Some(0.05),
    ),
    (
        "logfmt",
        "time=2026-01-01T14:00:00.100Z level=info msg=\"range read\" sensor=front distance=40.1\n\
      time=2026-01-01T14:00:00.130Z level=info msg=\"range read\" sensor=back distance=80.2\n\
      time=2026-01-01T14:00:00.160Z level=info msg=\"range read\" sensor=front distance=40.2\n",
        "front: 0.401 0.402; back: 0.802",
        Some(0.06),
    ),
    (
        "print of pandas by dates",
        "                         front  back\ntime                                \n\
      2026-01-01 14:00:00.000   40.1  80.2\n2026-01-01 14:00:00.050   40.2  80.3\n\
      2026-01-01 14:00:00.100   40.1  80.2\n",
        "front: 0.401 0.402 0.401; back: 0.802 0.803 0.802",
        Some(0.05),
    ),
    (
        "savetxt",
        "# t front back\n0.000000000000000000e+00 4.010000000000000142e+01 8.020000000000000284e+01\n\
      5.000000000000000277e-02 4.020000000000000284e+01 8.029999999999999716e+01\n",
        "front: 0.401 0.402; back: 0.802 0.803",
        Some(0.05),
    ),
    (
        "write.table",
        "\"t\" \"front\" \"back\"\n\"1\" 0 40.1 80.2\n\"2\" 0.05 40.2 80.3\n\"3\" 0.1 40.1 NA\n",
        "front: 0.401 0.402 0.401; back: 0.802 0.803 -",
        Some(0.05),
    ),
    (
        "Markdown",
        "| t | front | back |\n|---|------:|-----:|\n| 0.0 | 40.1 | 80.2 |\n| 0.1 | 40.2 | 80.3 |\n",
        "front: 0.401 0.402; back: 0.802 0.803",
        Some(0.1),
    ),
    (
        "org-mode",
        "| t | front | back |\n|---+-------+------|\n| 0.0 | 40.1 | 80.2 |\n| 0.1 | 40.2 | 80.3 |\n",
        "front: 0.401 0.402; back: 0.802 0.803",
        Some(0.1),
    ),
    (
        "a spreadsheet's days",
        "Date,front\n45234.5,40.1\n45234.5000005787,40.2\n45234.5000011574,40.3\n",
        "front: 0.401 0.402 0.403",
        Some(0.05),
    ),
    (
        "a YAML list",
        "- t: 0.0\n  front: 40.1\n  back: 80.2\n- t: 0.05\n  front: 40.2\n  back: null\n- t: 0.1\n  front: 40.\
         1\n  back: 80.3\n",
        "front: 0.401 0.402 0.401; back: 0.802 - 0.803",
        Some(0.05),
    ),
    (
        "PlotJuggler",
        "__time,/us_front/range,/us_back/range\n1700000000.000,0.401,0.802\n1700000000.050,0.402,0.803\n",
        "/us_front/range: 0.401 0.402; /us_back/range: 0.802 0.803",
        Some(0.05),
    ),
    (
        "bagpy",
        "Time,header.seq,header.stamp.secs,header.stamp.nsecs,header.frame_id,radiation_type,field_of_view,\
      min_range,max_range,range\n7.01,1,7,0,us1,0,0.5,0.02,4.0,1.25\n7.07,2,7,60000000,us1,0,0.5,0.02,4.0,1.5\n",
        "us1: 1.25 1.5",
        Some(0.06),
    ),
    (
        "Adafruit IO",
        "id,value,feed_id,created_at,lat,lon,ele\n0F4YA,40.1,2718,2026-01-01 14:00:00 UTC,,,\n\
      0F4YB,40.2,2718,2026-01-01 14:00:01 UTC,,,\n0F4YC,40.3,2718,2026-01-01 14:00:02 UTC,,,\n",
        "value: 0.401 0.402 0.403",
        Some(1.0),
    ),
    (
        "FHEM",
        "2026-01-01_14:00:00 Front distance: 40.1\n2026-01-01_14:00:01 Front distance: 40.2\n",
        "Front distance: 0.401 0.402",
        Some(1.0),
    ),
    (
        "IFTTT",
        "\"January 1, 2026 at 02:00PM\",front,40.1\n\"January 1, 2026 at 02:01PM\",front,40.2\n\
      \"January 1, 2026 at 02:02PM\",front,40.3\n",
        "front: 0.401 0.402 0.403",
        Some(60.0),
    ),
    (
        "Logger Pro",
        "Latest: Time (s),Latest: Position (m),Latest: Velocity (m/s)\n0,0.401,0.1\n0.05,0.406,0.1\n0.1,0.411,0.1\n",
        "Latest: Position (m): 0.401 0.406 0.411",
        Some(0.05),
    ),
    (
        "phyphox",
        "\"Time (s)\",\"Distance (m)\"\n0.000000000E0,4.010000000E-1\n5.000000000E-2,4.020000000E-1\n",
        "Distance (m): 0.401 0.402",
        Some(0.05),
    ),
];

#[test]
fn each_form_of_a_logger_gives_its_right_answer() {
    let mut wrong = vec![];
    for (name, text, sensors, step) in BOARDS.into_iter().chain(LOGGERS).chain(PROGRAMS) {
        let (found, seconds, report) = said(text.as_bytes(), &Options::default());
        let is_near = step.zip(seconds).is_none_or(|(step, seconds)| (step - seconds).abs() < 1e-4);
        let is_right = found == sensors && report.damage.is_empty() && is_near && step.is_some() == seconds.is_some();
        if !is_right {
            let damage: Vec<_> = report.damage.iter().map(ToString::to_string).collect();
            wrong.push(format!("{name}\n  expected {sensors} {step:?}\n  found    {found} {seconds:?} {damage:?}"));
        }
    }
    assert!(wrong.is_empty(), "{} wrong\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn damaged_line_among_messages_of_a_board_is_damage() {
    let start = "ets Jul 29 2019 12:21:46\nrst:0x1 (POWERON_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\nentry 0x400805f0\n";
    let lines = "front: 40 cm\nfront: 4ets Jul 29 2019 12:21:46\nfr\u{fffd}nt: 41 cm\nfront: 42 cm\n";
    let more = "front: 43 cm\nload: 7 cm\nfront: 4\u{0} cm\nfr\u{fffd}nt: 41 cm\nfront: 42 cm\n";
    let (found, _, report) = said(format!("{start}{lines}{start}{more}").as_bytes(), &Options::default());
    assert_eq!((found.as_str(), report.damage.len()), ("front: 0.4 0.42 0.43 0.42", 5), "{:?}", report.damage);
    assert!(report.skipped.iter().any(|skipped| skipped.why.starts_with("6 lines that a board")), "{report:?}");
}

#[test]
fn repetition_is_said_and_overridden() {
    let text = "front_cm,front_in\n40,15.7\n51,20.1\n69,27.2\n";
    let (found, _, report) = said(text.as_bytes(), &Options::default());
    assert_eq!(found, "front_cm: 0.4 0.51 0.69");
    let guess = report.guesses.iter().find(|guess| guess.what == "no sensors").unwrap();
    assert_eq!(guess.value, "`front_in` repeats `front_cm`");
    let mut options = Options::default();
    options.table.ranges = vec!["front_in".to_owned()];
    assert_eq!(said(text.as_bytes(), &options).0, "front_in: 0.399 0.511 0.691");
    options.table.ranges.push("front_cm".to_owned());
    assert!(said(text.as_bytes(), &options).0.contains("; "), "{text}");
    let columns = ["a_cm", "b_in"].map(str::to_owned).to_vec();
    let options = Options { table: Table { columns, ..Table::default() }, ..Options::default() };
    assert_eq!(said(text.as_bytes(), &options).0, "a_cm: 0.4 0.51 0.69; b_in: 0.399 0.511 0.691");
}

// Sensors side by side before a wall, one that is nearer by a constant factor, and one that falls silent.
#[test]
fn sensors_that_read_alike_stay_sensors() {
    let rows = |other: &dyn Fn(usize) -> String| {
        let row = |row: usize| format!("{},{}\n", 40 + row * 37 % 90, other(40 + row * 37 % 90));
        "left,right\n".to_owned() + &(0..60).map(row).collect::<String>()
    };
    let short: String = rows(&|cm| cm.to_string()).lines().take(12).map(|line| format!("{line}\n")).collect();
    let others: [&dyn Fn(usize) -> String; 4] = [
        &|cm| (cm + 1).to_string(),
        &|cm| (2 * cm).to_string(),
        &|cm| if cm == 54 { "0".to_owned() } else { cm.to_string() },
        &|cm| if cm % 10 == 4 { "153".to_owned() } else { (cm * 10).to_string() },
    ];
    for text in others.map(rows).into_iter().chain([short]) {
        assert_eq!(said(text.as_bytes(), &Options::default()).2.sensors.len(), 2, "{text}");
    }
    assert_eq!(said(rows(&|cm| cm.to_string()).as_bytes(), &Options::default()).2.sensors.len(), 1);
    assert_eq!(said(rows(&|cm| (cm * 10).to_string()).as_bytes(), &Options::default()).2.sensors.len(), 1);
}
