"""Starts the agent of one robot:  ros2 launch robot.launch.py robot:=a dimension:=3

radioslam-agent is a plain program, not a package of ROS 2; it must be on PATH.
"""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration

ARGUMENTS = {
    "robot": ("a", "name of the robot, and its namespace"),
    "dimension": ("2", "2 where the whole team drives on level ground, else 3; unused with mission"),
    "mission": ("", "folder with mission.yaml: antennas, anchors, noise"),
    "domain": ("0", "ROS_DOMAIN_ID"),
    "peers": ("", "hosts of the other robots, separated by commas; empty: found by multicast"),
    "topics": ("", "KIND=NAME, separated by commas: scans=/lidar/points,imu=imu/raw"),
    "use_sim_time": ("false", "take the time from /clock"),
    "output": ("", "folder of the result; default: radioslam-ROBOT"),
}


def several(option, text):
    return [word for part in text.split(",") if part for word in (option, part)]


def agent(context):
    value = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    command = ["radioslam-agent", "--robot", value["robot"], "--ros2", "--domain", value["domain"],
               "-o", value["output"] or "radioslam-" + value["robot"]]
    command += ["--mission", value["mission"]] if value["mission"] else ["--dimension", value["dimension"]]
    command += several("--peer", value["peers"]) + several("--topic", value["topics"])
    if value["use_sim_time"].lower() == "true":
        command.append("--use-sim-time")
    # SIGINT, with which launch ends it, makes it write its result; that takes some seconds.
    return [ExecuteProcess(cmd=command, output="screen", sigterm_timeout="60", sigkill_timeout="60")]


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, default_value=default, description=what)
                for name, (default, what) in ARGUMENTS.items()]
    return LaunchDescription(declared + [OpaqueFunction(function=agent)])
