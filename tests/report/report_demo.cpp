// Writes pages of synthetic runs into a folder for inspection: report_demo FOLDER
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "radioslam/report/report.hpp"
#include "report/sample_run.hpp"

namespace {

using radioslam::sample::make_sample;
using radioslam::sample::Sample;

void write(const std::filesystem::path& path, const std::string& page) {
  std::ofstream(path, std::ios::binary) << page;
  std::cout << path.string() << ": " << page.size() / 1000 << " kB\n";
}

std::string with_truth(const Sample& sample) {
  return render_report(sample.result, &sample.truth, sample.metrics);
}

std::string split_team() {
  Sample sample = make_sample({.robots = 4, .keyframes = 200, .closures = 60});
  sample.result.notes = {"The odometry's heading noise looks 2.4 times larger than stated."};
  sample.result.components = {{{"a", "b"}}, {{"c"}}};
  sample.result.unplaced = {"d"};
  sample.result.robots[3].placed = false;
  sample.result.weight = 0.8;
  sample.result.alternatives = {{0.2, sample.result.robots}};
  sample.result.parameters.clear();
  return render_report(sample.result);
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  std::filesystem::create_directories(folder);
  write(folder / "three.html", with_truth(make_sample({})));
  write(folder / "directions.html", with_truth(make_sample({.keyframes = 300, .aoa_measurements = 90})));
  write(folder / "one_direction.html", render_report(make_sample({.aoa_measurements = 1}).result));
  write(folder / "alone.html", with_truth(make_sample({.robots = 1, .keyframes = 300, .closures = 40})));
  write(folder / "space.html",
        with_truth(make_sample(
            {.robots = 2, .keyframes = 400, .candidates = 3000, .alternatives = 2, .dimension = 3})));
  write(folder / "many.html",
        with_truth(make_sample({.robots = 65, .keyframes = 500, .closures = 6000, .candidates = 50000})));
  write(
      folder / "huge.html",
      with_truth(make_sample({.robots = 20, .keyframes = 10000, .closures = 100000, .candidates = 300000})));
  write(folder / "split_no_truth.html", split_team());
  write(folder / "no_truth.html", render_report(make_sample({}).result));
  write(folder / "empty.html", render_report(radioslam::RunResult{}));
}
