#include "radioslam/cli/import/import_kinds.hpp"

#include <algorithm>

#include "radioslam/cli/import/import_commands.hpp"

namespace radioslam::cli {
namespace {

constexpr const char* kRosbagNotes =
    "Reads .bag (ROS 1), .mcap and .db3 files, also compressed (.zstd, .zst), or a folder of them; ROS is\n"
    "not needed. Each recording becomes one robot of the mission: a file, the parts of a split recording in\n"
    "a folder, or each recording in a folder of several. Several robots are named after their recordings.\n"
    "What is damaged in a recording is left out, with a note.\n"
    "\n"
    "Topics: if a recording has several topics of a kind, name the one to use, either once for all\n"
    "recordings or once per recording. A recording of several robots is given once, with their odometry\n"
    "topics one by one; these robots are named by what differs in the topics. Recorded poses become the\n"
    "ground truth only if --truth names their topic, because they could also be goals or estimates.\n"
    "Ranges (sensor_msgs/Range) go to radio/ranges.csv if their topic or its frame names two robots, or\n"
    "radios that --name gives to robots or anchors, or one of them besides the robot that recorded it;\n"
    "--ranges states both ends of a topic. Messages of UWB drivers, which name both radios, are read by the\n"
    "names of their fields (from_id, to_id, range, ...) where the recording has the types' definitions.\n"
    "WiFi: messages of drivers, which have types of their own, are read by the names of their fields: an\n"
    "address (bssid, mac, address, ...), a level in dBm (rssi, signal_level, ...), and perhaps a frequency\n"
    "or channel, once or in a list. Such are wireless_msgs/Connection, rf_msgs/AccessPoints,\n"
    "wifi_scan/Fingerprint, pr2_msgs/AccessPoint, wifi_ddwrt/SiteSurvey and jsk_network_tools/WifiStatus.\n"
    "The recording has to have their definitions, as bags and MCAP files do; a rosbag2 database may not.\n"
    "Frames: the body frame is the child frame of the odometry, otherwise base_link or base_footprint.\n"
    "Sensor extrinsics are taken from static transforms; a sensor without one is assumed to be at the\n"
    "body's origin, with a note. NavSatFix becomes position fixes in the east-north-up frame of the\n"
    "team's first fix that others agree with.";

constexpr const char* kKittiNotes =
    "Reads the layout of the KITTI odometry benchmark. Each SOURCE becomes one robot, with the LiDAR's\n"
    "frame as its body frame:\n"
    "  SOURCE/velodyne/*.bin       scans, float32 x y z intensity; also SOURCE/bin/, or in SOURCE itself\n"
    "                              (points of 3, 5, 6 or 7 floats are found by their numbers, with a note)\n"
    "  SOURCE/times.txt            seconds, a line per scan; if missing, times in names, or 10 Hz\n"
    "  SOURCE/calib.txt            Tr, Tr_velo_cam or Tr_velo_to_cam: the LiDAR's pose in the camera frame\n"
    "  SOURCE/../../poses/NAME.txt ground truth; also SOURCE/poses_kitti.txt, SOURCE/poses.txt or --poses\n"
    "This kind has no parameters.";

constexpr const char* kCarmenNotes =
    "Reads CARMEN logs with planar laser scans (FLASER, RLASER or ROBOTLASER1 lines) and the odometry of\n"
    "the same lines, also compressed (.gz, .bz2). Each SOURCE becomes one robot of a planar mission.\n"
    "Readings at the scanner's limit are missing returns and are left out. FLASER and RLASER lines do not\n"
    "state their angles: the readings cover field_of_view_deg.";

constexpr const char* kLogBegins =
    "A log holds many scans, each after a line with its Unix time (or other output of `date`):\n"
    "  while true; do date +%s.%N; ";
constexpr const char* kLogContinues =
    "; done >> log\n"
    "A file without such lines is one scan, with its time in its name (scan-1574407123.5.txt). SOURCE is "
    "one\n"
    "or several files or folders of files.";

constexpr const char* kWifiOutput =
    "\n"
    "\n"
    "The output is NAME.csv (the table alone), an existing mission (its robot gets the wifi.csv; a robot\n"
    "that it does not have is added), or a new mission, which still lacks odometry: `import imu` and\n"
    "`import waypoints` can add one. Without --robot, the robot is the mission's only one, or is named\n"
    "after the source.";

constexpr const char* kIwNotes =
    "Reads what `iw dev wlan0 scan` or `iw dev wlan0 scan dump` prints. Access points last seen before\n"
    "the previous scan are left out (--set keep_stale=true keeps them).\n";

constexpr const char* kIwlistNotes =
    "Reads what `iwlist wlan0 scan` prints. Levels in percent instead of dBm are left out. Access points\n"
    "whose last beacon is older than the previous scan are left out (--set keep_stale=true keeps them).\n";

constexpr const char* kNmcliNotes =
    "Reads what `nmcli -t -f BSSID,SSID-HEX,CHAN,FREQ,SIGNAL dev wifi list` prints; --fields states\n"
    "another list of fields. The table for people, `nmcli dev wifi list`, is read too. SIGNAL is\n"
    "converted from NetworkManager's percentage back to dBm.\n";

constexpr const char* kAirodumpNotes =
    "Reads the tables of airodump-ng: PREFIX-01.csv (a row per radio) or PREFIX-01.log.csv (a row per\n"
    "reception). Times are whole seconds of the recording machine's local clock: --set utc_offset_h=2\n"
    "converts them. The second table has no channels, so its frequencies are unknown. Stations are left\n"
    "out.";

constexpr const char* kPcapNotes =
    "Reads captures in monitor mode with radiotap headers, by tcpdump, airodump-ng or Wireshark (pcap or\n"
    "pcapng); SOURCE is one or several files or folders of files. Each beacon and probe response gives a\n"
    "row with its BSSID, level and frequency. Packets without a level, with malformed headers or with a\n"
    "wrong checksum are left out and counted.";

constexpr const char* kImuNotes =
    "Reads tables of an accelerometer and a gyroscope, carried by a walker, and makes the robot's\n"
    "odometry by pedestrian dead reckoning: steps from the vertical acceleration, heading from the\n"
    "gyroscope. SOURCE is a CSV table with both sensors, or one table per sensor. Columns are recognised\n"
    "by their names:\n"
    "  time            t_s, time, timestamp, seconds, ...; in s, ms, us or ns\n"
    "  accelerometer   ax, acc_x, accelerometer_x, linear_acceleration.x, ...; in m/s^2 or g, with gravity\n"
    "  gyroscope       wx, gx, gyro_x, angular_velocity.x, ...; in rad/s or degrees/s\n"
    "or x, y, z in a file whose name has acc or gyr. The device may be carried in any attitude that it\n"
    "keeps. The heading is relative to the start.";

constexpr const char* kWaypointsNotes =
    "Reads where a walker was when: a table t_s,x,y in metres, for example marked on a floor plan. The\n"
    "robot's odometry follows the straight lines between the waypoints at constant speed, facing forwards.\n"
    "Its start stays unknown; the note on it gives the initial_pose for mission.yaml, if the plan's frame "
    "is\n"
    "that of the team. This kind has no parameters.";

constexpr const char* kWalkOutput =
    "\n"
    "\n"
    "The output is an existing mission (its robot gets the odometry; a robot that it does not have is\n"
    "added) or a new one. Without --robot, the robot is the mission's only one, or is named after the\n"
    "source.";

constexpr const char* kAndroidNotes =
    "Reads what apps recorded on one phone. SOURCE is one or several files or folders of files, which are\n"
    "recognised by their content:\n"
    "  WiFi scans      CSV with a time, bssid or mac, rssi or level, and perhaps a frequency or channel:\n"
    "                  WiGLE, Sensor Logger (WiFi.csv), Network Survey and others\n"
    "  motion          CSV of an accelerometer and a gyroscope, as for `import imu`: Sensor Logger\n"
    "                  (TotalAcceleration.csv, or Accelerometer.csv and Gravity.csv, and Gyroscope.csv),\n"
    "                  Physics Toolbox, phyphox and others\n"
    "  both            logs of GetSensorData (ACCE;..., GYRO;..., WIFI;...) and of the site survey app of "
    "the\n"
    "                  Indoor Location Competition (TYPE_ACCELEROMETER ..., TYPE_WIFI ...)\n"
    "Scans become the robot's wifi.csv, motion its odometry by pedestrian dead reckoning. Positions and "
    "other\n"
    "sensors are not imported. Archives have to be unpacked.\n"
    "\n"
    "The output is an existing mission (its robot gets what it lacks; a robot that it does not have is "
    "added)\n"
    "or a new one. Without --robot, the robot is the mission's only one, or is named after the source.";

constexpr const char* kOdometryNotes =
    "Reads a robot's odometry: the TUM format (t x y z qx qy qz qw), or a table with a header that names\n"
    "a time, x, y and perhaps z, and yaw (or theta, heading; in rad, or in degrees if its name says so) or\n"
    "the quaternion qx, qy, qz, qw, such as `rostopic echo -p` writes. Fields are separated by commas,\n"
    "semicolons or tabs. The odometry is written from its start, as a mission has it. This kind has no\n"
    "parameters.";

constexpr const char* kIwFtmNotes =
    "Reads WiFi round-trip times (fine time measurement, IEEE 802.11mc) as printed by `iw dev wlan0\n"
    "measurement ftm_request FILE` or `iw event -t`, and writes a ranges.csv. --robot, which is required,\n"
    "names the robot that measured.\n"
    "\n"
    "Copy the table to radio/ranges.csv of the mission; each radio in it that is not a robot needs a row\n"
    "in radio/anchors.csv, with empty coordinates if its position is unknown.";

constexpr const char* kIndoorLocationNotes =
    "Reads phone logs of the Indoor Location Competition 2.0: one log, or a folder with logs\n"
    ".../path_data_files/ID.txt of one floor. Each walk becomes one robot. Its odometry is pedestrian\n"
    "dead reckoning with an absolute heading, its ground truth the waypoints.";

constexpr const char* kWifineNotes =
    "Reads the WiFine data set: one of its CSV files, or a folder of them. Each trajectory becomes one\n"
    "robot with WiFi scans and ground truth. There is no odometry and no common clock, and frequencies\n"
    "are unknown. This kind has no parameters.";

constexpr const char* kWifiRttNotes =
    "Reads one walk of the WiFi RTT data set (a folder): WiFi scans and round-trip ranges of two phones,\n"
    "M1 and M2, to six access points and to each other, with ground truth and the access points'\n"
    "positions. There is no odometry. Ranges are not corrected for the phones' bias.";

constexpr const char* kDpgoNotes =
    "Reads the measurement tables of dpgo (robot_src,pose_src,robot_dst,pose_dst,qx,...,tau): one or\n"
    "several tables, or a folder with robotN/measurements.csv. Robot 0 becomes a, 1 becomes b, ... Rows\n"
    "between robots stand in the tables of both and count once. `weight` and `is_known_inlier` are not\n"
    "read.\n"
    "\n"
    "The output is NAME.g2o, a team's graph for `run`, or a mission: odometry with a pose per second, and\n"
    "matches.csv for all other measurements. A mission takes roll and pitch from gravity, and its odometry\n"
    "noise is a random walk; the g2o file has the measurements alone.";

/// Notes on a tool that prints scan lists: what is particular to it, then what all of them have in common.
std::string scan_list_notes(const std::string& particular, const std::string& command) {
  return particular + kLogBegins + command + kLogContinues + kWifiOutput;
}

ImportKind scan_list_kind(const char* name, const char* summary, const std::string& particular,
                          const std::string& command, const std::string& example) {
  return {name,
          summary,
          import_printed_scans,
          {ImportOption::kRobot, ImportOption::kTime, ImportOption::kParameters},
          scan_list_notes(particular, command),
          {example}};
}

/// Kinds that are written as missions.
std::vector<ImportKind> recording_kinds() {
  return {
      {"rosbag",
       "ROS 1 and ROS 2 recordings, as a mission",
       import_ros_recordings,
       {ImportOption::kRobots, ImportOption::kTopics, ImportOption::kName},
       kRosbagNotes,
       {"radioslam import rosbag drive.mcap --list",
        "radioslam import rosbag team.db3 --odometry /r1/odom --odometry /r2/odom --name uwb_7=r1 --name "
        "uwb_9=r2 -o mission",
        "radioslam import rosbag one.bag two.bag --odometry /odom --scans /points --truth /mocap -o "
        "mission"}},
      {"kitti",
       "LiDAR drives in the layout of the KITTI odometry benchmark, as a mission",
       import_kitti_drives,
       {ImportOption::kRobots, ImportOption::kPoses},
       kKittiNotes,
       {"radioslam import kitti sequences/08 -o mission"}},
      {"carmen",
       "CARMEN logs with planar laser scans and odometry, as a mission",
       import_carmen_logs,
       {ImportOption::kRobots, ImportOption::kParameters},
       kCarmenNotes,
       {"radioslam import carmen intel.clf.bz2 -o mission"}},
  };
}

/// Kinds that are written as one table of a robot.
std::vector<ImportKind> wifi_tool_kinds() {
  ImportKind nmcli = scan_list_kind("nmcli", "output of `nmcli dev wifi list`, as a robot's wifi.csv",
                                    kNmcliNotes, "nmcli -t -f BSSID,SSID-HEX,CHAN,FREQ,SIGNAL dev wifi list",
                                    "radioslam import nmcli log --robot a -o mission");
  nmcli.options.push_back(ImportOption::kFields);
  return {
      scan_list_kind("iw", "output of `iw dev wlan0 scan`, as a robot's wifi.csv", kIwNotes,
                     "iw dev wlan0 scan", "radioslam import iw log --robot a -o mission"),
      scan_list_kind("iwlist", "output of `iwlist wlan0 scan`, as a robot's wifi.csv", kIwlistNotes,
                     "iwlist wlan0 scan", "radioslam import iwlist scans/ --robot a -o mission"),
      std::move(nmcli),
      {"airodump",
       "tables of airodump-ng, as a robot's wifi.csv",
       import_airodump,
       {ImportOption::kRobot, ImportOption::kParameters},
       std::string(kAirodumpNotes) + kWifiOutput,
       {"radioslam import airodump dump-01.csv --robot a --set utc_offset_h=2 -o mission"}},
      {"pcap",
       "WiFi captures in monitor mode (pcap, pcapng), as a robot's wifi.csv",
       import_wifi_captures,
       {ImportOption::kRobot, ImportOption::kParameters},
       std::string(kPcapNotes) + kWifiOutput,
       {"radioslam import pcap monitor.pcapng -o wifi.csv"}},
      {"iw-ftm",
       "WiFi round-trip times printed by iw, as a ranges.csv",
       import_ftm_ranges,
       {ImportOption::kRobot, ImportOption::kName, ImportOption::kParameters},
       kIwFtmNotes,
       {"radioslam import iw-ftm ftm.txt --robot a --name 02:00:00:00:01:00=door -o ranges.csv"}},
      {"android",
       "WiFi scans and motion recorded by apps on a phone, as a robot",
       import_android,
       {ImportOption::kRobot, ImportOption::kParameters},
       kAndroidNotes,
       {"radioslam import android WigleWifi.csv --robot a -o mission",
        "radioslam import android recording/ --robot b -o mission"}},
      {"odometry",
       "a table of poses, as a robot's odometry",
       import_odometry,
       {ImportOption::kRobot},
       std::string(kOdometryNotes) + kWalkOutput,
       {"radioslam import odometry odom.csv --robot a -o mission"}},
      {"imu",
       "accelerometer and gyroscope of a walker, as a robot's odometry",
       import_imu,
       {ImportOption::kRobot, ImportOption::kParameters},
       std::string(kImuNotes) + kWalkOutput,
       {"radioslam import imu phone.csv --robot laptop -o mission",
        "radioslam import imu Accelerometer.csv Gyroscope.csv --robot laptop -o mission"}},
      {"waypoints",
       "a table of places and times, as a robot's odometry",
       import_waypoints,
       {ImportOption::kRobot},
       std::string(kWaypointsNotes) + kWalkOutput,
       {"radioslam import waypoints plan.csv --robot laptop -o mission"}},
  };
}

/// Public data sets, written as missions.
std::vector<ImportKind> dataset_kinds() {
  return {
      {"indoor-location",
       "phone logs of the Indoor Location Competition 2.0, as a mission",
       import_phone_logs,
       {ImportOption::kParameters},
       kIndoorLocationNotes,
       {"radioslam import indoor-location site1/F1 -o mission"}},
      {"wifine",
       "the WiFine data set, as a mission without odometry",
       import_wifine_trajectories,
       {},
       kWifineNotes,
       {"radioslam import wifine test/ -o mission"}},
      {"wifi-rtt",
       "the WiFi RTT data set, as a mission without odometry",
       import_rtt_walk,
       {ImportOption::kParameters},
       kWifiRttNotes,
       {"radioslam import wifi-rtt corridor/ -o mission"}},
      {"dpgo",
       "measurement tables of dpgo, as a g2o file or a mission",
       import_dpgo_tables,
       {},
       kDpgoNotes,
       {"radioslam import dpgo tunnels/ -o tunnels.g2o"}},
  };
}

}  // namespace

const std::vector<ImportKind>& import_kinds() {
  static const std::vector<ImportKind> all = [] {
    std::vector<ImportKind> kinds = recording_kinds();
    for (const auto& more : {wifi_tool_kinds(), dataset_kinds()})
      kinds.insert(kinds.end(), more.begin(), more.end());
    return kinds;
  }();
  return all;
}

const ImportKind* find_import_kind(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  for (const ImportKind& kind : import_kinds())
    if (name == kind.name) return &kind;
  return nullptr;
}

}  // namespace radioslam::cli
