// One error at a time in an otherwise valid mission: the message names the file and the line.
#include "io/example_mission.hpp"
#include "io/refusal.hpp"
#include "radioslam/io/mission/mission_folder.hpp"

namespace radioslam {
namespace {

struct Malformed {
  const char* name;
  const char* file;     ///< file that is changed
  std::string content;  ///< new content of the file
  std::size_t line;     ///< file named by the error
  const char* words;    ///< words in the message
};

std::ostream& operator<<(std::ostream& out, const Malformed& bad) { return out << bad.name; }

class MalformedMission : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedMission, IsRefusedWithFileAndLine) {
  const Malformed& bad = GetParam();
  const TemporaryFolder folder;
  Files files = example_mission();
  files[bad.file] = bad.content;
  write_files(folder, files);
  const auto read = [&] { read_truth(folder.path(), read_mission(folder.path())); };
  expect_refusal(read, bad.line, bad.words);
  EXPECT_NE(refusal(read).find((folder.path() / bad.file).string()), std::string::npos);
}

std::string print(const testing::TestParamInfo<Malformed>& info) { return info.param.name; }

const std::string kRow = "0 0 0 0 0 0 0 1\n";
constexpr const char* kOdometryFile = "robots/a/odometry.tum";
INSTANTIATE_TEST_SUITE_P(
    Odometry, MalformedMission,
    testing::Values(
        Malformed{"TornLine", kOdometryFile, kRow + "1 1 0 0 0", 2, "the file ends in this line"},
        Malformed{"Nan", kOdometryFile, kRow + "1 nan 0 0 0 0 0 1\n", 2, "not a finite number"},
        Malformed{"Infinity", kOdometryFile, kRow + "1 0 0 0 0 0 0 inf\n", 2, "not a finite number"},
        Malformed{"TimeNan", kOdometryFile, kRow + "nan 0 0 0 0 0 0 1\n", 2, "not a time"},
        Malformed{"TooFewColumns", kOdometryFile, kRow + "1 1 0 0 0 0 0\n" + "2 " + kRow, 2, "ends before"},
        Malformed{"TooManyColumns", kOdometryFile, kRow + "1 1 0 0 0 0 0 1 1\n", 2, "too many"},
        Malformed{"Backwards", kOdometryFile, "5 0 0 0 0 0 0 1\n4 0 0 0 0 0 0 1\n", 2, "backwards"},
        Malformed{"SameTime", kOdometryFile, kRow + kRow, 2, "twice"},
        Malformed{"Huge", kOdometryFile, kRow + "1 1e9 0 0 0 0 0 1\n", 2, "plausible"},
        Malformed{"ZeroQuaternion", kOdometryFile, kRow + "1 0 0 0 0 0 0 0\n", 2, "quaternion is zero"},
        Malformed{"LongQuaternion", kOdometryFile, kRow + "1 0 0 0 0 0 0 2\n", 2, "norm is 2"},
        Malformed{"TruthLongQuaternion", "robots/b/groundtruth.tum", kRow + "1 0 0 0 0.5 0.5 0 0\n", 2,
                  "norm is 0.7"},
        Malformed{"Words", kOdometryFile, kRow + "one two\n", 2, "not a time"},
        Malformed{"Binary", kOdometryFile, kRow + std::string("\x00\x01\xfe\xff", 4), 2, "control character"},
        Malformed{"NotUtf8", kOdometryFile, kRow + std::string("\xfe\xff", 2), 2, "not UTF-8"},
        Malformed{"TimeOverflow", kOdometryFile, "1e30 0 0 0 0 0 0 1\n", 1, "not a time"},
        Malformed{"Empty", kOdometryFile, "", 1, "empty"},
        Malformed{"OnlyComments", kOdometryFile, "# none\n", 1, "no poses"},
        Malformed{"Truth", "robots/b/groundtruth.tum", kRow + "1 2 3\n", 2, "ends before"}),
    print);

const std::string kWifiHeader = "t_s,bssid,frequency_mhz,rssi_dbm\n";
const std::string kAoaHeader = "t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db\n";
const std::string kMatchHeader = "robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw,sigma_t_m,sigma_r_rad\n";
constexpr const char* kWifi = "robots/b/wifi.csv";
INSTANTIATE_TEST_SUITE_P(
    Tables, MalformedMission,
    testing::Values(
        Malformed{"WifiMissingColumn", kWifi, "t_s,bssid,rssi_dbm\n1,aa,-60\n", 1,
                  "'frequency_mhz' is missing"},
        Malformed{"WifiTorn", kWifi, kWifiHeader + "1,aa,2412,-60\n1,bb,24", 3, "the file ends in this line"},
        Malformed{"WifiNan", kWifi, kWifiHeader + "1,aa,2412,NaN\n", 2, "not a finite number"},
        Malformed{"WifiRssi", kWifi, kWifiHeader + "1,aa,2412,2412\n", 2, "outside"},
        Malformed{"WifiEmpty", kWifi, "", 1, "empty"},
        Malformed{"RangeUnknownRobot", "radio/ranges.csv",
                  "t_s,robot_i,robot_j,range_m,sigma_m\n1,a,b,3,0.1\n1,a,zed,3,0.1\n", 3,
                  "unknown robot 'zed'"},
        Malformed{"RangeSigma", "radio/ranges.csv", "t_s,robot_i,robot_j,range_m,sigma_m\n1,a,b,3,-0.1\n", 2,
                  "negative"},
        Malformed{"RangeHuge", "radio/ranges.csv", "t_s,robot_i,robot_j,range_m,sigma_m\n1,a,b,1e9,1\n", 2,
                  "plausible"},
        Malformed{"AoaFromAnAnchor", "radio/aoa.csv", kAoaHeader + "1,A1,a,0,0,0,1,0\n", 2,
                  "unknown robot 'A1'"},
        Malformed{"AnchorTwice", "radio/anchors.csv", "id,x_m,y_m,z_m,sigma_m\nA1,,,,\nA1,,,,\n", 3, "twice"},
        Malformed{"AnchorLikeRobot", "radio/anchors.csv", "id,x_m,y_m,z_m,sigma_m\na,,,,\n", 2,
                  "id of a robot"},
        Malformed{"AnchorNan", "radio/anchors.csv", "id,x_m,y_m,z_m,sigma_m\nA1,nan,1,1,1\n", 2, "finite"},
        Malformed{"MatchUnknownRobot", "matches.csv", kMatchHeader + "a,1,c,0,1,2,0,0,0,0,1,0.1,0.01\n", 2,
                  "unknown robot 'c'"},
        Malformed{"MatchMissingColumn", "matches.csv", "robot_i,t_i_s,robot_j\na,1,b\n", 1, "missing"},
        Malformed{"RangeNegative", "radio/ranges.csv", "t_s,robot_i,robot_j,range_m,sigma_m\n1,a,b,-1,0.5\n",
                  2, "negative"},
        Malformed{"RangeItself", "radio/ranges.csv", "t_s,robot_i,robot_j,range_m,sigma_m\n1,a,a,3,0.1\n", 2,
                  "a range from 'a' to itself"},
        Malformed{"RangeSigmaZero", "radio/ranges.csv", "t_s,robot_i,robot_j,range_m,sigma_m\n1,a,b,3,0\n", 2,
                  "sigma is zero"},
        Malformed{"AoaItself", "radio/aoa.csv", kAoaHeader + "1,a,a,0,0,0,1,0\n", 2,
                  "an angle from 'a' to itself"},
        Malformed{"AoaSigmaZero", "radio/aoa.csv", kAoaHeader + "1,a,b,0,0,0,0,0\n", 2, "sigma is zero"},
        Malformed{"MatchItself", "matches.csv", kMatchHeader + "b,1,b,1.0,1,2,0,0,0,0,1,0.1,0.01\n", 2,
                  "a match at the same time from 'b' to itself"},
        Malformed{"MatchSigmaZero", "matches.csv", kMatchHeader + "a,1,b,1,1,2,0,0,0,0,1,0.1,0\n", 2,
                  "sigma is zero"},
        Malformed{"MatchSigmaNegative", "matches.csv", kMatchHeader + "a,1,b,1,1,2,0,0,0,0,1,-1,1\n", 2,
                  "negative"},
        Malformed{"MatchLongQuaternion", "matches.csv", kMatchHeader + "a,1,b,1,1,2,0,0,0,1,1,1,1\n", 2,
                  "norm is 1.41"},
        Malformed{"FixSigmaZero", "robots/b/gnss.csv", "t_s,x_m,y_m,z_m,sigma_m\n1,0,0,0,0\n", 2,
                  "sigma is zero"},
        Malformed{"DirectPathUnknown", "radio/direct_paths.csv", "t_s,receiver,transmitter,path\n0.5,a,b,1\n",
                  2, "no path 1"},
        Malformed{"DirectPathNegative", "radio/direct_paths.csv",
                  "t_s,receiver,transmitter,path\n0.5,a,b,-2\n", 2, "neither"},
        Malformed{"DirectPathUnknownRobot", "radio/direct_paths.csv",
                  "t_s,receiver,transmitter,path\n0.5,a,zed,0\n", 2, "unknown robot 'zed'"},
        Malformed{"MatchLabel", "match_labels.csv", "robot_i,t_i_s,robot_j,t_j_s,label\na,1,b,0,1\n", 2,
                  "neither true nor false"},
        Malformed{"ImuEmpty", "robots/a/imu.csv", "", 1, "empty"},
        Malformed{
            "ImuBackwards", "robots/a/imu.csv",
            "t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps\n2,0,0,9.8,0,0,0\n1,0,0,9.8,0,0,0\n", 3,
            "does not increase"},
        Malformed{"ImuNan", "robots/a/imu.csv",
                  "t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps\n2,0,nan,9.8,0,0,0\n", 2, "nan"},
        Malformed{"FixFarAway", "robots/b/gnss.csv", "t_s,x_m,y_m,z_m,sigma_m\n1,1e9,0,0,1\n", 2, "1e9"}),
    print);

constexpr const char* kYaml = "mission.yaml";
const std::string kFormat = "format: radioslam-mission/1\n";
const std::string kRobots = kFormat + "robots:\n  a: {}\n  b: {}\n";
INSTANTIATE_TEST_SUITE_P(
    Yaml, MalformedMission,
    testing::Values(
        Malformed{"BadYaml", kYaml, kFormat + "robots: {a: {}\n", 3, "not valid YAML"},
        Malformed{"Tab", kYaml, kFormat + "robots:\n\ta: {}\n", 3, "not valid YAML"},
        Malformed{"CyclicRobots", kYaml, kFormat + "robots: &r\n  a: {}\n  b: *r\n", 3, "unknown key 'a'"},
        Malformed{"CyclicDefaults", kYaml, kRobots + "defaults: &d\n  odometry: *d\n", 6,
                  "unknown key 'odometry'"},
        Malformed{"CyclicKey", kYaml, kFormat + "robots: &r\n  ? *r\n  : {}\n", 2, "a key must be"},
        Malformed{"CyclicPose", kYaml, kRobots + "defaults:\n  initial_pose: &p [1, 2, *p, 0]\n", 6,
                  "initial_pose must be a single value"},
        Malformed{"UnknownKey", kYaml, kRobots + "dimensions:\n  3\n", 5, "unknown key 'dimensions'"},
        Malformed{"UnknownOdometryKey", kYaml, kRobots + "defaults:\n  odometry:\n    sigma: 1\n", 7,
                  "unknown key 'sigma' in odometry"},
        Malformed{"UnknownRobotKey", kYaml, kFormat + "robots:\n  a: {}\n  b: {headings: absolute}\n", 4,
                  "unknown key 'headings' in robot 'b'"},
        Malformed{"DuplicateRobot", kYaml, kFormat + "robots:\n  a: {}\n  b: {}\n  a: {}\n", 5, "twice"},
        Malformed{"NegativeSigma", kYaml, kRobots + "defaults:\n  odometry: {sigma_yaw_per_rad: -0.1}\n", 6,
                  "sigma_yaw_per_rad is negative"},
        Malformed{"SigmaNan", kYaml, kRobots + "defaults:\n  odometry: {sigma_yaw_per_rad: .nan}\n", 6,
                  "not a finite number"},
        Malformed{"Format", kYaml, "format: radioslam-mission/2\nrobots: {a: {}, b: {}}\n", 1, "is not"},
        Malformed{"NoFormat", kYaml, "robots: {a: {}, b: {}}\n", 1, "missing"},
        Malformed{"NoRobots", kYaml, kFormat + "robots: {}\n", 2, "no robots"},
        Malformed{"RobotsMissing", kYaml, kFormat, 1, "'robots' is missing"},
        Malformed{"RobotsList", kYaml, kFormat + "robots: [a, b]\n", 2, "robots must hold"},
        Malformed{"Dimension", kYaml, kRobots + "dimension: 4\n", 5, "neither 2 nor 3"},
        Malformed{"Heading", kYaml, kRobots + "defaults: {heading: north}\n", 5, "heading 'north'"},
        Malformed{"InitialPose", kYaml, kRobots + "defaults:\n  initial_pose: [1, 2, 3]\n", 6,
                  "initial_pose"},
        Malformed{"InitialPoseHuge", kYaml, kRobots + "defaults: {initial_pose: [1e9, 2, 3, 0]}\n", 5,
                  "plausible"},
        Malformed{"LidarRange", kYaml, kRobots + "defaults: {lidar: {range_m: 0}}\n", 5, "not positive"},
        Malformed{"LidarView", kYaml, kRobots + "defaults: {lidar: {view_deg: 361}}\n", 5, "(0, 360]"},
        Malformed{"AntennaInThePlane", kYaml, kRobots + "defaults: {antennas: {top: [1, 2]}}\n", 5,
                  "antenna 'top' is not [x, y, z]"},
        Malformed{"AntennaWithComma", kYaml, kRobots + "defaults: {antennas: {'a,b': [1, 2, 3]}}\n", 5,
                  "does not have a valid name"},
        Malformed{"AntennaNan", kYaml, kRobots + "defaults: {antennas: {top: [1, 2, .nan]}}\n", 5,
                  "not a finite number"},
        Malformed{"CsiMac", kYaml, kRobots + "defaults:\n  csi: {mac: '00:16:ea:00:00'}\n", 6,
                  "mac '00:16:ea:00:00' is not a MAC address"},
        Malformed{"CsiChannel", kYaml, kRobots + "defaults:\n  csi:\n    channel: 20\n", 7,
                  "channel '20' is not the number of a WiFi channel"},
        Malformed{"CsiChannelWord", kYaml, kRobots + "defaults: {csi: {channel: six}}\n", 5,
                  "channel 'six' is not"},
        Malformed{
            "CsiUnknownAntenna", kYaml,
            kRobots + "defaults:\n  antennas: {front: [1, 0, 0]}\n  csi:\n    antennas: [front,\n  back]\n",
            9, "unknown antenna 'back' in csi"},
        Malformed{"CsiAntennaTwice", kYaml,
                  kRobots + "defaults: {antennas: {f: [1, 0, 0]}, csi: {antennas: [f, f]}}\n", 5,
                  "'f' appears twice"},
        Malformed{"CsiAntennaNoList", kYaml, kRobots + "defaults: {csi: {antennas: f}}\n", 5,
                  "list of names"},
        Malformed{"CsiUnknownKey", kYaml, kRobots + "defaults: {csi: {address: 1}}\n", 5,
                  "unknown key 'address' in csi"},
        Malformed{"CsiSharedMac", kYaml,
                  kFormat + "robots:\n  a:\n  b:\ndefaults: {csi: {mac: 00-16-EA-00-00-01}}\n", 4,
                  "robot 'b' has the same mac 00:16:ea:00:00:01 as robot 'a'"},
        Malformed{"IdWithSlash", kYaml, kFormat + "robots:\n  a: {}\n  b/../../c: {}\n", 4,
                  "valid file name"},
        Malformed{"IdUp", kYaml, kFormat + "robots:\n  ..: {}\n", 3, "valid file name"},
        Malformed{"RobotWithoutOdometry", kYaml, kRobots + "  c: {}\n", 5, "no robots/c/odometry.tum"},
        Malformed{"UnlistedRobotFolder", kYaml, kFormat + "\nrobots:\n  a: {}\n", 4, "unknown robot 'b'"},
        Malformed{"Scalar", kYaml, "just words\n", 1, "must hold"},
        Malformed{"Empty", kYaml, "", 1, "empty"}),
    print);

TEST(MalformedFolder, IsRefused) {
  const TemporaryFolder folder;
  expect_refusal([&] { read_mission(folder.path() / "none"); }, 0, "no such mission folder");
  expect_refusal([&] { read_mission(folder.path()); }, 0, "no mission.yaml");
  expect_refusal([&] { read_mission(folder.write("file", "x")); }, 0, "is a file");
}

TEST(MalformedFolder, AFolderInPlaceOfAFileIsRefused) {
  const TemporaryFolder folder;
  Files files = example_mission();
  files.erase("robots/a/odometry.tum");
  write_files(folder, files);
  std::filesystem::create_directory(folder.path() / "robots/a/odometry.tum");
  expect_refusal([&] { read_mission(folder.path()); }, 0, "odometry.tum: is a folder");
}

}  // namespace
}  // namespace radioslam
