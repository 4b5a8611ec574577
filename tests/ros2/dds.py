"""Messages of ROS 2 as Cyclone DDS takes them, and readers for them, of Fast DDS too, on the loopback interface."""

import os
import time
import types
from dataclasses import dataclass

# Read when the domain is made.
os.environ["CYCLONEDDS_URI"] = """<CycloneDDS><Domain>
<General><AllowMulticast>false</AllowMulticast>
<Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer Address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""

from cyclonedds.core import Policy, Qos
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float32, float64, int32, int64, sequence, uint8, uint32
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from fast_dds import FastDds

NODE = os.environ["EERUF_ROS2"]
# Ports of higher domains are among those that the system gives away.
DOMAIN = 1 + os.getpid() % 90
PATIENCE_S = 60
OK, WARN, ERROR = 0, 1, 2


def message(typename, /, **fields):
    """The type of a message, as `std_msgs/Header`, or of a service's part, as `rcl_interfaces/srv/GetParameters_Request`."""
    *package, name = typename.split("/")
    package = "::".join(package if len(package) == 2 else [*package, "msg"])
    body = {"__annotations__": fields, "__module__": __name__}
    made = types.new_class(name, (IdlStruct,), {"typename": f"{package}::dds_::{name}_"}, lambda own: own.update(body))
    return dataclass(made)


def numbers(kind, names):
    return dict.fromkeys(names.split(), kind)


Time = message("builtin_interfaces/Time", sec=int32, nanosec=uint32)
Header = message("std_msgs/Header", stamp=Time, frame_id=str)
SPAN = numbers(float32, "field_of_view min_range max_range range variance")
Range = message("sensor_msgs/Range", header=Header, radiation_type=uint8, **SPAN)
KeyValue = message("diagnostic_msgs/KeyValue", key=str, value=str)
WORDS = numbers(str, "name message hardware_id")
DiagnosticStatus = message("diagnostic_msgs/DiagnosticStatus", level=uint8, **WORDS, values=sequence[KeyValue])
DiagnosticArray = message("diagnostic_msgs/DiagnosticArray", header=Header, status=sequence[DiagnosticStatus])
PointField = message("sensor_msgs/PointField", name=str, offset=uint32, datatype=uint8, count=uint32)
SHAPE = {"height": uint32, "width": uint32, "fields": sequence[PointField], "is_bigendian": bool}
STEPS = {"point_step": uint32, "row_step": uint32, "data": sequence[uint8], "is_dense": bool}
PointCloud2 = message("sensor_msgs/PointCloud2", header=Header, **SHAPE, **STEPS)
RAYS = numbers(float32, "angle_min angle_max angle_increment time_increment scan_time range_min range_max")
LISTS = numbers(sequence[float32], "ranges intensities")
LaserScan = message("sensor_msgs/LaserScan", header=Header, **RAYS, **LISTS)
Vector3 = message("geometry_msgs/Vector3", **numbers(float64, "x y z"))
Quaternion = message("geometry_msgs/Quaternion", **numbers(float64, "x y z w"))
Transform = message("geometry_msgs/Transform", translation=Vector3, rotation=Quaternion)
TransformStamped = message("geometry_msgs/TransformStamped", header=Header, child_frame_id=str, transform=Transform)
TFMessage = message("tf2_msgs/TFMessage", transforms=sequence[TransformStamped])
Pose = message("geometry_msgs/Pose", position=Vector3, orientation=Quaternion)
PoseWithCovariance = message("geometry_msgs/PoseWithCovariance", pose=Pose, covariance=array[float64, 36])
Twist = message("geometry_msgs/Twist", linear=Vector3, angular=Vector3)
TwistWithCovariance = message("geometry_msgs/TwistWithCovariance", twist=Twist, covariance=array[float64, 36])
MOTION = {"pose": PoseWithCovariance, "twist": TwistWithCovariance}
Odometry = message("nav_msgs/Odometry", header=Header, child_frame_id=str, **MOTION)
WHERE = {"file": str, "function": str, "line": uint32}
Log = message("rcl_interfaces/Log", stamp=Time, level=uint8, name=str, msg=str, **WHERE)
VALUES = {"bool_value": bool, "integer_value": int64, "double_value": float64, "string_value": str}
ARRAYS = {"bytes": uint8, "bools": bool, "integers": int64, "doubles": float64, "strings": str}
ARRAYS = {name: sequence[kind] for name, kind in ARRAYS.items()}
ParameterValue = message("rcl_interfaces/ParameterValue", type=uint8, **VALUES, **ARRAYS)
Parameter = message("rcl_interfaces/Parameter", name=str, value=ParameterValue)
SetParametersResult = message("rcl_interfaces/SetParametersResult", successful=bool, reason=str)

RELIABLE = Qos(
    Policy.Reliability.Reliable(duration(seconds=1)),
    Policy.History.KeepAll,
    Policy.DataRepresentation(use_cdrv0_representation=True),
)
# As tf2's listener asks for /tf_static.
LATCHED = Qos(
    Policy.Reliability.Reliable(duration(seconds=1)),
    Policy.Durability.TransientLocal,
    Policy.History.KeepLast(100),
    Policy.DataRepresentation(use_cdrv0_representation=True),
)


def reader(participant, name, kind, qos=RELIABLE):
    """A reader of the topic with this full name."""
    if isinstance(participant, FastDds):
        return participant.reader(f"rt{name}", kind, latched=qos is LATCHED)
    return DataReader(participant, Topic(participant, f"rt{name}", kind, qos=qos), qos=qos)


def taken(reader, kind):
    """Samples that have come. When the node leaves, Cyclone DDS says so in samples that are none."""
    return [sample for sample in reader.take(N=1000) if isinstance(sample, kind)]


def environment():
    """Variables for the node."""
    variables = {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN), "ROS_LOCALHOST_ONLY": "1"}
    variables.pop("ROS_AUTOMATIC_DISCOVERY_RANGE", None)
    return variables


def until(what, process, holds):
    end = time.monotonic() + PATIENCE_S
    while not holds():
        assert process.poll() is None, process.communicate()[1]
        assert time.monotonic() < end, f"{what} did not happen within {PATIENCE_S} s"
        time.sleep(0.02)
