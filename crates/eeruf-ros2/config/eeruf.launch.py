"""Starts eeruf-ros2 as a process of a ROS 2 launch: `ros2 launch ./eeruf.launch.py params_file:=eeruf.yaml`.

eeruf-ros2 is a program of its own and in no ROS package: it must be in PATH, as after `cargo install eeruf-ros2`.
"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    """The node, started anew if it ends by itself."""
    beside = str(Path(__file__).with_name("eeruf.yaml"))
    params_file = DeclareLaunchArgument("params_file", default_value=beside, description="parameters, as YAML")
    name = DeclareLaunchArgument("name", default_value="eeruf", description="the node's name")
    node = ExecuteProcess(
        cmd=[
            "eeruf-ros2",
            "--params-file",
            LaunchConfiguration("params_file"),
            "--name",
            LaunchConfiguration("name"),
        ],
        name="eeruf_ros2",
        output="screen",
        respawn=True,
        respawn_delay=2.0,
    )
    return LaunchDescription([params_file, name, node])
