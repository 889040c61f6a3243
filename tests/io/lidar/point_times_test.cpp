#include "radioslam/io/lidar/point_times.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "radioslam/io/text/byte_view.hpp"

namespace radioslam {
namespace {

using Unit = PointTimeUnit;
constexpr Stamp kStamp{1'700'000'000'000'000'000};
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Points at one metre and more with times, and the bytes that their table refers to.
class TimedPoints {
 public:
  void add(double time, float x = 1) {
    rows_.push_back({x, time, std::isfinite(time) ? static_cast<std::int64_t>(time) : 0});
  }
  void add_whole(std::int64_t time, float x = 1) { rows_.push_back({x, static_cast<double>(time), time}); }

  PointTable table(NumberType type) {
    bytes_.clear();
    const std::size_t stride = 12 + bytes_of(type);
    for (const Row& row : rows_) {
      append_f32(bytes_, row.x);
      append_f32(bytes_, 0);
      append_f32(bytes_, 0);
      append_time(row, type);
    }
    const auto f32 = NumberType::kFloat32;
    return {bytes_,
            ByteOrder::kLittle,
            rows_.size(),
            {{"x", f32, 0, stride}, {"y", f32, 4, stride}, {"z", f32, 8, stride}, {"t", type, 12, stride}}};
  }

 private:
  struct Row {
    float x;
    double time;
    std::int64_t whole;
  };

  void append_time(const Row& row, NumberType type) {
    if (type == NumberType::kFloat32)
      append_f32(bytes_, static_cast<float>(row.time));
    else if (type == NumberType::kFloat64)
      append_f64(bytes_, row.time);
    else
      append_little_endian(bytes_, static_cast<std::uint64_t>(row.whole), bytes_of(type));
  }

  std::vector<Row> rows_;
  std::string bytes_;
};

/// A sweep of 0.1 s that begins at `first_s`.
TimedPoints sweep(double first_s, double per_second) {
  TimedPoints points;
  for (int k = 0; k <= 10; ++k) points.add_whole(std::llround((first_s + 0.01 * k) * per_second));
  return points;
}

void expect_sweep(const PointTimes& times, double first_s) {
  ASSERT_EQ(times.since_stamp_s.size(), 11U);
  for (std::size_t k = 0; k < 11; ++k)
    EXPECT_NEAR(static_cast<double>(times.since_stamp_s[k]), first_s + 0.01 * static_cast<double>(k), 1e-5);
}

/// Times as drivers write them: integers since the scan's stamp, and other variants.
TEST(PointTimes, AreSinceTheStampInEveryUnit) {
  for (const double interval_s : {0.05, 0.1, 0.2, 3.0})
    for (const auto& [unit, per_second] :
         {std::pair{Unit::kMillisecond, 1e3}, {Unit::kMicrosecond, 1e6}, {Unit::kNanosecond, 1e9}})
      for (const NumberType type : {NumberType::kInt32, NumberType::kInt64, NumberType::kFloat32}) {
        TimedPoints points = sweep(-0.1, per_second);
        const PointTable table = points.table(type);
        EXPECT_EQ(unit_of({*raw_times_of(table)}, interval_s), unit) << interval_s << ' ' << per_second;
        const PointTimes times = times_of(table, kStamp, unit);
        EXPECT_EQ(times.clock, PointClock::kScans);
        expect_sweep(times, -0.1);
      }
}

TEST(PointTimes, AreAbsoluteBeyondAMillionSeconds) {
  for (const auto& [unit, per_second] : {std::pair{Unit::kMicrosecond, 1e6}, {Unit::kNanosecond, 1e9}})
    for (const NumberType type : {NumberType::kUint64, NumberType::kFloat64}) {
      TimedPoints points = sweep(1'700'000'000, per_second);
      const PointTable table = points.table(type);
      EXPECT_EQ(raw_times_of(table)->nominal, Unit::kNanosecond);
      EXPECT_EQ(unit_of({*raw_times_of(table)}, 0.1), unit);
      expect_sweep(times_of(table, kStamp, unit), 0);
    }
}

/// A partial sweep, or one every few minutes, keeps the nominal unit.
TEST(PointTimes, KeepTheUsualUnitWhereItCanBe) {
  EXPECT_EQ(unit_of({{Unit::kNanosecond, 1e8}}, 60), Unit::kNanosecond);
  EXPECT_EQ(unit_of({{Unit::kSecond, 0.1}}, 60), Unit::kSecond);
  EXPECT_EQ(unit_of({{Unit::kSecond, 5}}, 5), Unit::kSecond) << "a slow scanner";
  EXPECT_EQ(unit_of({{Unit::kNanosecond, 2e6}}, 0.1), Unit::kNanosecond) << "a narrow view";
  EXPECT_EQ(unit_of({{Unit::kSecond, 0}}, 0.1), Unit::kSecond);
  EXPECT_EQ(unit_of({{Unit::kSecond, 1e30}}, 0.1), Unit::kSecond) << "none fits";
  EXPECT_EQ(unit_of({{Unit::kNanosecond, 1e5}, {Unit::kNanosecond, 1e5}, {Unit::kNanosecond, 1e20}}, 0.1),
            Unit::kMicrosecond)
      << "one of three is corrupt";
}

/// Leap seconds, a scanner that counts from power-on, and an arbitrary clock.
TEST(PointTimes, OfAnotherClockBeginAtTheStamp) {
  for (const double first_s :
       {1'700'000'018.0, 1'699'999'982.0, 1'700'000'000.0 + 37 * 3600, 2600.0, -50.0}) {
    TimedPoints points = sweep(first_s, 1e9);
    const PointTimes times = times_of(points.table(NumberType::kInt64), kStamp);
    EXPECT_EQ(times.clock, PointClock::kOther) << first_s;
    expect_sweep(times, 0);
  }
  TimedPoints late = sweep(1'700'000'000.5, 1e9);
  expect_sweep(times_of(late.table(NumberType::kInt64), kStamp), 0.5);
  TimedPoints slow;
  slow.add(1.5);
  slow.add(20);
  EXPECT_EQ(times_of(slow.table(NumberType::kFloat32), kStamp).since_stamp_s, (std::vector<float>{1.5F, 20}))
      << "a scan that takes its time";
}

TEST(PointTimes, TooCoarseAreIgnored) {
  TimedPoints points;
  points.add(1.7e9);
  points.add(1.7e9 + 0.1);
  const PointTimes times = times_of(points.table(NumberType::kFloat32), kStamp);
  EXPECT_EQ(times.clock, PointClock::kCoarse);
  EXPECT_TRUE(times.since_stamp_s.empty());
}

/// Some drivers give missing returns the time 0.
TEST(PointTimes, DoNotCountWhereThereIsNoPoint) {
  TimedPoints points = sweep(1'700'000'018, 1e9);
  points.add_whole(0, 0);
  points.add_whole(5, kNone);
  const PointTable table = points.table(NumberType::kInt64);
  EXPECT_EQ(raw_times_of(table)->span, 1e8);
  EXPECT_EQ(times_of(table, kStamp).since_stamp_s[10], 0.1F);
  TimedPoints unknown;
  unknown.add(static_cast<double>(kNone));
  unknown.add(0.25);
  const PointTimes times = times_of(unknown.table(NumberType::kFloat32), kStamp);
  EXPECT_TRUE(std::isnan(times.since_stamp_s[0]));
  EXPECT_EQ(times.since_stamp_s[1], 0.25F);
}

TEST(PointTimes, WithoutAColumnAreEmpty) {
  TimedPoints points = sweep(0, 1e9);
  PointTable table = points.table(NumberType::kInt64);
  table.columns.pop_back();
  EXPECT_FALSE(raw_times_of(table));
  EXPECT_TRUE(times_of(table, kStamp).since_stamp_s.empty());
}

TEST(PointTimes, OfOneConstantAreDiscarded) {
  const auto f64 = NumberType::kFloat64;
  for (const NumberType type : {NumberType::kFloat32, f64, NumberType::kUint32, NumberType::kInt64})
    for (const double constant : {0.0, 0.05, 17.0, 1e9, 1.7326e18}) {
      if (type == NumberType::kUint32 && constant > 4e9) continue;
      TimedPoints points;
      for (int k = 0; k < 3; ++k) points.add(constant);
      const PointTimes times = times_of(points.table(type), kStamp);
      EXPECT_TRUE(times.since_stamp_s.empty()) << constant;
      const bool is_coarse = type == NumberType::kFloat32 && constant > 1e6;
      EXPECT_EQ(times.clock, is_coarse ? PointClock::kCoarse : PointClock::kConstant) << constant;
    }
  TimedPoints rounded;
  for (const double ns : {0.0, 256.0, 512.0}) rounded.add(1.7326e18 + ns);
  EXPECT_EQ(times_of(rounded.table(f64), kStamp).clock, PointClock::kConstant);
  TimedPoints missing;  // a point without a return has no time
  missing.add(7);
  missing.add(0, 0);
  missing.add(7);
  EXPECT_EQ(times_of(missing.table(f64), kStamp).clock, PointClock::kConstant);
  TimedPoints alone;
  alone.add(0.25);
  EXPECT_EQ(times_of(alone.table(f64), kStamp).since_stamp_s, std::vector<float>{0.25F});
}

TEST(PointTimes, ThatAreTheSameInAllScansAreFrozen) {
  const std::vector<RawPointTimes> same(3, {Unit::kNanosecond, 1e8, 1.7e18});
  EXPECT_TRUE(are_frozen(same, 0.2, Unit::kNanosecond));
  EXPECT_FALSE(are_frozen({same[0], same[0]}, 0.1, Unit::kNanosecond)) << "of two it could be chance";
  auto advancing = same;
  advancing[1].first += 1e8;
  advancing[2].first += 2e8;
  EXPECT_FALSE(are_frozen(advancing, 0.2, Unit::kNanosecond));
  EXPECT_FALSE(are_frozen(std::vector<RawPointTimes>(3, {Unit::kSecond, 0.1, 0.0}), 0.2, Unit::kSecond))
      << "times relative to the stamp are the same in all scans";
}

}  // namespace
}  // namespace radioslam
