// Output and exit status of the program for valid and invalid command lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

constexpr const char* kTriangle =
    "EDGE_SE2 0 1 1 0 2.0944 100 0 0 100 0 100\n"
    "EDGE_SE2 1 2 1 0 2.0944 100 0 0 100 0 100\n"
    "EDGE_SE2 2 0 1.1 0 2.0944 100 0 0 100 0 100\n";

bool is_one_line(const std::string& text) {
  return !text.empty() && text.back() == '\n' && std::count(text.begin(), text.end(), '\n') == 1;
}

/// Expects exit status 2, nothing on standard output, no file, and one line with `reason` in it.
void expect_call_refused(const std::vector<std::string>& arguments, const std::string& reason) {
  const TemporaryFolder folder;
  const auto outcome = run(arguments, folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(is_one_line(outcome.err)) << outcome.err;
  EXPECT_EQ(outcome.err.rfind("radioslam: ", 0), 0U) << outcome.err;
  EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
  EXPECT_TRUE(files_in(folder.path()).empty());
}

TEST(Calls, WithoutArgumentsHelp) {
  const TemporaryFolder folder;
  const auto outcome = run({}, folder.path());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.out.find("radioslam simulate carpark"), std::string::npos);
  EXPECT_EQ(outcome.err, "");
}

TEST(Calls, EveryCommandHelpsWithAnExample) {
  const TemporaryFolder folder;
  for (const char* command : {"simulate", "run", "evaluate", "import", "optimize", "similarity", "anchors",
                              "parameters", "prune"}) {
    const auto outcome = run({command, "--help"}, folder.path());
    EXPECT_EQ(outcome.status, 0) << command;
    EXPECT_NE(outcome.out.find(std::string("  radioslam ") + command), std::string::npos) << command;
  }
}

TEST(Calls, VersionIsOneLine) {
  const TemporaryFolder folder;
  const auto outcome = run({"--version"}, folder.path());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out.rfind("radioslam ", 0), 0U);
  EXPECT_TRUE(is_one_line(outcome.out));
}

TEST(Calls, MisspellingsAreRefusedWithASuggestion) {
  expect_call_refused({"optimise"}, "did you mean optimize?");
  expect_call_refused({"--verison"}, "did you mean --version?");
  expect_call_refused({"optimize", "g.g2o", "-o", "out.g2o", "--jsn"}, "did you mean --json?");
  expect_call_refused({"simulate", "carpak", "-o", "m"}, "did you mean carpark?");
  expect_call_refused({"simulate", "carpark", "-o", "m", "--set", "robot=2"}, "did you mean robots?");
  expect_call_refused({"run", "m", "-o", "out", "--set", "keyfram.distance_m=1"},
                      "did you mean keyframe.distance_m?");
  expect_call_refused({"import", "indoor", "x", "-o", "m"}, "unknown kind of source");
}

TEST(Calls, MissingAndSurplusArgumentsAreRefused) {
  expect_call_refused({"optimize"}, "GRAPH is required");
  expect_call_refused({"optimize", "g.g2o"}, "--output is required");
  expect_call_refused({"optimize", "g.g2o", "-o", "out", "--loss-share", "0.1"},
                      "losses and delays belong to --distributed");
  expect_call_refused({"evaluate", "out"}, "needs a mission with ground truth, or --truth ROBOT=FILE");
  expect_call_refused({"similarity", "a.csv", "-o", "pairs.csv"}, "--measure is required");
}

/// Writes `file`, runs the program, and expects an error that leaves the file unchanged.
void expect_kept(const std::string& file, const std::string& content,
                 const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  std::filesystem::create_directories((folder.path() / file).parent_path());
  write_file(folder.path() / file, content);
  const auto outcome = run(arguments, folder.path());
  EXPECT_EQ(outcome.status, 2) << file;
  EXPECT_NE(outcome.err.find("would be replaced"), std::string::npos) << outcome.err;
  EXPECT_EQ(read_file(folder.path() / file), content);
}

TEST(Calls, NothingReplacesWhatItReads) {
  const std::string scans = "t_s,bssid,frequency_mhz,rssi_dbm\n0,ap1,2412,-50\n1,ap1,2412,-51\n";
  const std::string list = "BSS 02:00:00:00:01:00(on wlan0)\n\tfreq: 2412\n\tsignal: -53.00 dBm\n";
  expect_kept("x.csv", scans, {"similarity", "x.csv", "--measure", "cosine", "-o", "x.csv"});
  expect_kept("x.csv", scans, {"similarity", "z.csv", "x.csv", "--measure", "cosine", "-o", "a/../x.csv"});
  expect_kept("g.g2o", kTriangle, {"optimize", "g.g2o", "-o", "./g.g2o"});
  expect_kept("p.tum", "0 0 0 0 0 0 0 1\n", {"aoa", "c.dat", "--trajectory", "p.tum", "-o", "p.tum"});
  expect_kept("out/d.csv", "id_i,id_j,distance_m\n", {"anchors", "out/d.csv", "-o", "out"});
  expect_kept("log.csv", list, {"import", "iw", "log.csv", "-o", "log.csv"});
  expect_kept("logs/log.csv", list, {"import", "iw", "logs", "-o", "logs/log.csv"});
  expect_kept("log.csv", list, {"import", "iw-ftm", "log.csv", "--robot", "a", "-o", "log.csv"});
  expect_kept("out/g.g2o", kTriangle, {"run", "out/g.g2o", "-o", "out"});
}

TEST(Calls, WhatIsBesideAnInputIsWritten) {
  const TemporaryFolder folder;
  write_file(folder.path() / "g.g2o", kTriangle);
  EXPECT_EQ(run({"optimize", "g.g2o", "-o", "g.g2o.optimum"}, folder.path()).status, 0);
  EXPECT_EQ(run({"run", "g.g2o", "-o", "g"}, folder.path()).status, 0);
}

TEST(Calls, ValuesOutOfRangeAreRefused) {
  expect_call_refused({"run", "m", "-o", "out", "--set", "keyframe.distance_m=0"}, "0.01 to 1000 m");
  expect_call_refused({"run", "m", "-o", "out", "--threads", "0"}, "--threads");
  expect_call_refused({"simulate", "carpark", "-o", "m", "--robots", "0"}, "--robots");
  expect_call_refused({"simulate", "carpark", "-o", "m", "--seed", "x"}, "--seed");
  expect_call_refused({"simulate", "carpark", "-o", "m", "--seed", "-1"}, "--seed: '-1' is not");
  expect_call_refused({"simulate", "carpark", "-o", "m", "--seed", "18446744073709551616"}, "--seed");
  expect_call_refused({"simulate", "carpark", "-o", "m", "--seed", "1.5"}, "--seed");
  for (const char* radius : {"-1", "nan", "inf", "1e999", "x", ""})
    expect_call_refused({"evaluate", "out", "m", "--radius", radius}, "--radius");
  for (const char* minimum : {"-0.1", "nan", "1.1", "-inf"})
    expect_call_refused({"similarity", "a.csv", "--measure", "cosine", "-o", "p.csv", "--min", minimum},
                        "--min");
}

TEST(Calls, MissingInputsAreNamed) {
  expect_call_refused({"run", "nowhere", "-o", "out"}, "nowhere");
  expect_call_refused({"evaluate", "nowhere", "nowhere"}, "nowhere");
  expect_call_refused({"optimize", "nothing.g2o", "-o", "out.g2o"}, "nothing.g2o");
  expect_call_refused({"import", "indoor-location", "nowhere", "-o", "out"}, "nowhere");
  expect_call_refused({"similarity", "a.csv", "--measure", "cosine", "-o", "pairs.csv"}, "a.csv");
  expect_call_refused({"run", "m", "-o", "out", "--config", "none.yaml"}, "none.yaml");
}

TEST(Calls, SettingsMayFollowOneAnother) {
  const TemporaryFolder folder;
  write_file(folder.path() / "g.g2o", kTriangle);
  const auto outcome =
      run({"optimize", "--set", "max_iterations=0", "first_damping=1e-3", "g.g2o", "-o", "o.g2o", "--json"},
          folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["iterations"], 0);
}

TEST(Calls, OptimizePrintsOneJsonObjectAndNothingElse) {
  const TemporaryFolder folder;
  write_file(folder.path() / "g.g2o", kTriangle);
  const auto outcome = run({"optimize", "g.g2o", "-o", "o.g2o", "--json"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto json = nlohmann::json::parse(outcome.out);
  for (const char* key :
       {"initial_cost", "start_cost", "final_cost", "iterations", "seconds", "termination", "certificate"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  for (const char* key : {"read", "initialise", "optimise"})
    EXPECT_TRUE(json["seconds"].contains(key)) << key;
  EXPECT_TRUE(json["certificate"].is_null());
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"g.g2o", "o.g2o"}));
}

TEST(Calls, OptimizeReportsTheCostsOfTheFilesVerticesAndOfTheStart) {
  const TemporaryFolder folder;
  const auto optimized = [&](const std::string& graph) {
    write_file(folder.path() / "g.g2o", graph);
    const auto outcome = run({"optimize", "g.g2o", "-o", "o.g2o", "--json"}, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };
  // Off by (3, 4) from the only edge: 100 * (3^2 + 4^2).
  const auto given =
      optimized("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 4 4 0\nEDGE_SE2 0 1 1 0 0 100 0 0 100 0 100\n");
  EXPECT_NEAR(given["initial_cost"], 2500, 1e-9);
  EXPECT_NEAR(given["start_cost"], 0, 1e-9);
  EXPECT_NE(given["start"], "file");
  const auto none = optimized(kTriangle);
  EXPECT_EQ(none["initial_cost"], none["start_cost"]);
  EXPECT_GE(none["start_cost"], none["final_cost"]);
}

TEST(Calls, IndefiniteInformationIsRefusedOrRepairedOnDemand) {
  const TemporaryFolder folder;
  write_file(folder.path() / "g.g2o", std::string(kTriangle) + "EDGE_SE2 0 2 1 0 0 1 0 0 -1 0 1\n");
  const auto refused = run({"optimize", "g.g2o", "-o", "o.g2o"}, folder.path());
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("g.g2o:4:"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("--repair-information"), std::string::npos) << refused.err;
  const auto repaired = run({"optimize", "g.g2o", "-o", "o.g2o", "--repair-information"}, folder.path());
  EXPECT_EQ(repaired.status, 0) << repaired.err;
  EXPECT_NE(repaired.out.find("repaired 1 indefinite"), std::string::npos);
}

TEST(Calls, CertifyIsRefusedPlainly) {
  expect_call_refused({"optimize", "g.g2o", "-o", "o.g2o", "--certify"}, "--certify");
}

TEST(Calls, ParametersListUnitsAndRanges) {
  const TemporaryFolder folder;
  const auto text = run({"parameters"}, folder.path());
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("keyframe.distance_m = 1 m   [0.01 to 1000]\n"), std::string::npos);
  const auto json = run({"parameters", "simulate", "--json"}, folder.path());
  EXPECT_EQ(nlohmann::json::parse(json.out)["robots"]["range"], "1 to 100");
  EXPECT_EQ(run({"parameters", "indoor-location"}, folder.path()).out,
            run({"parameters", "import"}, folder.path()).out);
  const auto none = run({"parameters", "rosbag"}, folder.path());
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.err, "radioslam: parameters rosbag: this import has no parameters\n");
}

TEST(Calls, ParametersListTheBasicOnesUnlessAllAreWanted) {
  const TemporaryFolder folder;
  const auto basic = run({"parameters"}, folder.path());
  EXPECT_EQ(basic.out.find("radio.bin_width"), std::string::npos);
  EXPECT_TRUE(basic.out.ends_with(" more: radioslam parameters run --all\n")) << basic.out;
  EXPECT_EQ(run({"parameters", "prune"}, folder.path()).out.find("radio.bin_width"), std::string::npos);
  const auto all = run({"parameters", "run", "--all"}, folder.path());
  EXPECT_NE(all.out.find("radio.bin_width = 0.05"), std::string::npos);
  EXPECT_EQ(all.out.find(" more: "), std::string::npos);
  // Short lists are complete.
  const auto angles = run({"parameters", "aoa"}, folder.path());
  EXPECT_EQ(angles.out, run({"parameters", "aoa", "--all"}, folder.path()).out);
  EXPECT_NE(angles.out.find("model_passes"), std::string::npos);
}

TEST(Calls, ParametersAsJsonHaveLevels) {
  const TemporaryFolder folder;
  const auto json = nlohmann::json::parse(run({"parameters", "run", "--json"}, folder.path()).out);
  EXPECT_EQ(json["keyframe.distance_m"]["level"], "basic");
  EXPECT_EQ(json["scan_structure.elongation"]["level"], "expert");
}

}  // namespace
}  // namespace radioslam::cli
