BEGIN TRANSACTION;
CREATE TABLE message_definitions(
      id INTEGER PRIMARY KEY,
      topic_type TEXT NOT NULL,
      encoding TEXT NOT NULL,
      encoded_message_definition TEXT NOT NULL,
      type_description_hash TEXT NOT NULL
    );
INSERT INTO "message_definitions" VALUES(1,'sensor_msgs/msg/Range','ros2msg','uint8 ULTRASOUND=0
uint8 INFRARED=1
std_msgs/Header header
uint8 radiation_type
float32 field_of_view
float32 min_range
float32 max_range
float32 range
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
','RIHS01_9430b1915b94d4268ff903679e8ecd09b6a67d331bd028738ec1eeb592891ebd');
CREATE TABLE messages(
      id INTEGER PRIMARY KEY,
      topic_id INTEGER NOT NULL,
      timestamp INTEGER NOT NULL,
      data BLOB NOT NULL
    );
INSERT INTO "messages" VALUES(1,1,1700000000000000000,X'0001000000F153650000000008000000736F6E61725F3000000000000000803E0AD7A33C000080400000803F');
INSERT INTO "messages" VALUES(2,2,1700000000000000000,X'0001000000F153650000000008000000736F6E61725F3100000000000000803E0AD7A33C000080400000A03F');
INSERT INTO "messages" VALUES(3,1,1700000000100000000,X'0001000000F1536500E1F50508000000736F6E61725F3000000000000000803E0AD7A33C000080400000823F');
INSERT INTO "messages" VALUES(4,2,1700000000100000000,X'0001000000F1536500E1F50508000000736F6E61725F3100000000000000803E0AD7A33C000080400000A23F');
INSERT INTO "messages" VALUES(5,1,1700000000200000000,X'0001000000F1536500C2EB0B08000000736F6E61725F3000000000000000803E0AD7A33C000080400000807F');
INSERT INTO "messages" VALUES(6,2,1700000000200000000,X'0001000000F1536500C2EB0B08000000736F6E61725F3100000000000000803E0AD7A33C000080400000807F');
INSERT INTO "messages" VALUES(7,1,1700000000300000000,X'0001000000F1536500A3E11108000000736F6E61725F3000000000000000803E0AD7A33C00008040000080FF');
INSERT INTO "messages" VALUES(8,2,1700000000300000000,X'0001000000F1536500A3E11108000000736F6E61725F3100000000000000803E0AD7A33C00008040000080FF');
INSERT INTO "messages" VALUES(9,1,1700000000400000000,X'0001000000F153650084D71708000000736F6E61725F3000000000000000803E0AD7A33C000080400000C07F');
INSERT INTO "messages" VALUES(10,2,1700000000400000000,X'0001000000F153650084D71708000000736F6E61725F3100000000000000803E0AD7A33C000080400000C07F');
INSERT INTO "messages" VALUES(11,1,1700000000500000000,X'0001000000F153650065CD1D08000000736F6E61725F3000000000000000803E0AD7A33C0000804000008A3F');
INSERT INTO "messages" VALUES(12,2,1700000000500000000,X'0001000000F153650065CD1D08000000736F6E61725F3100000000000000803E0AD7A33C000080400000AA3F');
CREATE TABLE metadata(
      id INTEGER PRIMARY KEY,
      metadata_version INTEGER NOT NULL,
      metadata TEXT NOT NULL
    );
INSERT INTO "metadata" VALUES(1,9,'compression_format: ''''
compression_mode: ''''
custom_data: null
duration:
  nanoseconds: 500000000
files:
- duration:
    nanoseconds: 500000000
  message_count: 12
  path: sqlite-humble.db3
  starting_time:
    nanoseconds_since_epoch: 1700000000000000000
message_count: 12
relative_file_paths:
- sqlite-humble.db3
ros_distro: rosbags
starting_time:
  nanoseconds_since_epoch: 1700000000000000000
storage_identifier: sqlite3
topics_with_message_count:
- message_count: 6
  topic_metadata:
    name: /sonar/0
    offered_qos_profiles: []
    serialization_format: cdr
    type: sensor_msgs/msg/Range
    type_description_hash: 
      RIHS01_9430b1915b94d4268ff903679e8ecd09b6a67d331bd028738ec1eeb592891ebd
- message_count: 6
  topic_metadata:
    name: /sonar/1
    offered_qos_profiles: []
    serialization_format: cdr
    type: sensor_msgs/msg/Range
    type_description_hash: 
      RIHS01_9430b1915b94d4268ff903679e8ecd09b6a67d331bd028738ec1eeb592891ebd
version: 9');
CREATE TABLE schema(
      schema_version INTEGER PRIMARY KEY,
      ros_distro TEXT NOT NULL
    );
INSERT INTO "schema" VALUES(4,'rosbags');
CREATE TABLE topics(
      id INTEGER PRIMARY KEY,
      name TEXT NOT NULL,
      type TEXT NOT NULL,
      serialization_format TEXT NOT NULL,
      offered_qos_profiles TEXT NOT NULL,
      type_description_hash TEXT NOT NULL
    );
INSERT INTO "topics" VALUES(1,'/sonar/0','sensor_msgs/msg/Range','cdr','[]','RIHS01_9430b1915b94d4268ff903679e8ecd09b6a67d331bd028738ec1eeb592891ebd');
INSERT INTO "topics" VALUES(2,'/sonar/1','sensor_msgs/msg/Range','cdr','[]','RIHS01_9430b1915b94d4268ff903679e8ecd09b6a67d331bd028738ec1eeb592891ebd');
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
COMMIT;
