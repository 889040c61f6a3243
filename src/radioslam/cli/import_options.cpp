#include "radioslam/cli/import_options.hpp"

#include "radioslam/io/usable_id.hpp"

namespace radioslam::cli {
namespace {

constexpr const char* kKinds =
    "indoor-location: phone logs of walks on one floor, into a mission;\n"
    "iw-ftm: what `iw dev wlan0 measurement ftm_request` or `iw event -t` printed, into a ranges.csv;\n"
    "iw, iwlist, nmcli: what `iw dev wlan0 scan`, `iwlist wlan0 scan` or\n"
    "`nmcli -t -f BSSID,SSID-HEX,CHAN,FREQ,SIGNAL dev wifi list` printed, into a robot's wifi.csv;\n"
    "airodump: airodump-ng's .csv or .log.csv, likewise;\n"
    "pcap: a capture in monitor mode (pcap, pcapng; radiotap), likewise;\n"
    "wifine, wifi-rtt: these datasets, into missions without odometry;\n"
    "carmen: a log of CARMEN (also .gz, .bz2) with odometry and a plane's laser scans, into a mission;\n"
    "kitti: a folder with LiDAR scans (.bin), times.txt, poses and calib.txt as the KITTI odometry\n"
    "benchmark has them, likewise;\n"
    "rosbag: a recording of ROS 1 or ROS 2 (.bag, .mcap, .db3, or a folder of them), likewise";

constexpr const char* kImportFooter =
    "`radioslam parameters KIND` lists what --set can change; of kitti, rosbag and wifine it is nothing.\n"
    "A mission takes a robot's ranges in radio/ranges.csv; each radio that is no robot needs a "
    "row "
    "in\n"
    "radio/anchors.csv, empty coordinates where its place is unknown.\n\n"
    "A log of scans has a line with the Unix time before each:\n"
    "  while true; do date +%s.%N; iw dev wlan0 scan; done >> log\n"
    "Otherwise a file is one scan, and its time stands in its name (scan-1574407123.5.txt). What iw heard "
    "before\n"
    "the previous scan is a leftover and left out. airodump's times are local: --set utc_offset_h=2.\n\n"
    "carmen, kitti and rosbag make a team of several sources, a robot of each. What rosbag is to take where\n"
    "there are several topics of a kind is said once, or once per source; one recording may be given twice.\n"
    "Poses become the truth only when --truth says so: others may be goals or estimates.\n\n"
    "Example: the walks of one floor; a robot's distances to two access points; what it heard; laser scans\n"
    "  radioslam import indoor-location site1/F1 -o walks\n"
    "  radioslam import iw-ftm ftm.txt --robot a --name 02:00:00:00:01:00=door -o ranges.csv\n"
    "  radioslam import iw log --robot a -o mission\n"
    "  radioslam import pcap monitor.pcapng -o wifi.csv\n"
    "  radioslam import carmen intel.clf.bz2 -o mission\n"
    "  radioslam import kitti sequences/08 -o mission\n"
    "  radioslam import rosbag drive.mcap --list\n"
    "  radioslam import rosbag one.bag two.bag --odometry /odom --scans /points --truth /mocap -o mission";

/// An option that may be given several times, each with one value.
void add_repeated_option(CLI::App& command, const char* name, std::vector<std::string>& values,
                         const char* type, const char* what) {
  command.add_option(name, values, what)->type_name(type)->expected(1)->take_all();
}

void add_wifi_options(CLI::App& command, ImportOptions& options) {
  add_repeated_option(command, "--name", options.names, "BSSID=ID",
                      "iw-ftm: call this radio so, an anchor or another robot; its BSSID by default");
  command.add_option("--fields", options.fields, "nmcli: what its -f was told")->type_name("NAME,...");
  command
      .add_option(
          "--time", options.time,
          "iw, iwlist, nmcli: when the (first) scan of a file without times was made; else its name tells, "
          "else iw's seconds since the machine started, else it is 0")
      ->type_name("SECONDS");
  command.add_flag("--file-times", options.file_times,
                   "iw, iwlist, nmcli: files without times were last written at their last scan");
}

void add_lidar_options(CLI::App& command, ImportOptions& options) {
  add_repeated_option(command, "--poses", options.poses, "FILE",
                      "kitti: the true poses, twelve numbers a line; by default what lies beside the scans");
  add_repeated_option(
      command, "--odometry", options.odometry, "TOPIC",
      "rosbag: of Odometry or poses, or /tf:FRAME.CHILD, or none; by default the only Odometry");
  add_repeated_option(command, "--scans", options.scans, "TOPIC",
                      "rosbag: of PointCloud2 or LaserScan, or none; by default the only one");
  add_repeated_option(command, "--imu", options.imu, "TOPIC",
                      "rosbag: of Imu, or none; by default the only one");
  add_repeated_option(command, "--gnss", options.gnss, "TOPIC",
                      "rosbag: of NavSatFix, or none; by default the only one");
  add_repeated_option(command, "--truth", options.truth, "TOPIC",
                      "rosbag: the true poses, as for --odometry; none by default");
  command.add_flag("--list", options.list, "rosbag: list topics, types and numbers of messages instead");
}

}  // namespace

void check_import_id(const std::string& option, const std::string& id) {
  if (!is_usable_id(id))
    throw InputError(option, 0, "'" + id + "' cannot be the name of a robot or an anchor");
}

void add_import_options(CLI::App& command, ImportOptions& options) {
  command.add_option("KIND", options.kind, kKinds)->required();
  command
      .add_option(
          "SOURCE", options.sources,
          "A log, or a folder that holds logs; several of what WiFi tools heard, and of carmen, kitti\n"
          "and rosbag one per robot")
      ->required();
  command
      .add_option("-o,--output", options.output,
                  "The mission folder, or the ranges.csv or wifi.csv, to write; replaced if there is one.\n"
                  "Of what WiFi tools heard: a mission gets a robots/ID/wifi.csv and keeps the rest")
      ->type_name("PATH");
  add_repeated_option(
      command, "--robot", options.robots, "ID",
      "The robot that measured or heard; of carmen, kitti and rosbag one per source, a, b, ... "
      "by default");
  add_wifi_options(command, options);
  add_lidar_options(command, options);
  add_parameter_options(command, options.parameters);
  add_threads_option(command);
  command.footer(kImportFooter);
}

}  // namespace radioslam::cli
