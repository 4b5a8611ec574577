"""Starts the node: `ros2 launch eeruf_ros2 eeruf.launch.py params_file:=eeruf.yaml namespace:=robot_1`."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the node, which restarts if it ends by itself."""
    defaults = str(Path(__file__).parents[1] / "config" / "eeruf.yaml")
    arguments = {
        "params_file": (defaults, "parameters, as YAML"),
        "namespace": ("", "the node's namespace"),
        "name": ("eeruf", "the node's name, by which its parameters are found"),
    }
    node = Node(
        package="eeruf_ros2",
        executable="eeruf-ros2",
        namespace=LaunchConfiguration("namespace"),
        name=LaunchConfiguration("name"),
        parameters=[LaunchConfiguration("params_file")],
        output="screen",
        respawn=True,
        respawn_delay=2.0,
    )
    declared = [
        DeclareLaunchArgument(argument, default_value=value, description=description)
        for argument, (value, description) in arguments.items()
    ]
    return LaunchDescription([*declared, node])
