#include "radioslam/io/text/csv.hpp"

#include "io/refusal.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"

namespace radioslam {
namespace {

enum : std::size_t { kX, kY, kExtra };

Text text(const std::string& content) { return make_text("c.csv", content); }

TEST(Csv, FindsColumnsByNameInAnyOrderAndIgnoresOthers) {
  const Text t = text("# made by hand\nother, y ,\"x\"\n\nfoo, 2 ,1\n,\"4\",3\n");
  CsvReader csv(t, {{"x", "y"}, {"extra"}});
  EXPECT_FALSE(csv.has(kExtra));
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.number(kX), 1);
  EXPECT_EQ(csv.number(kY), 2);
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.number(kX), 3);
  EXPECT_EQ(csv.number(kY), 4);
  EXPECT_FALSE(csv.next());
}

TEST(Csv, TakesAllQuotesAndBlanksAwayFromAroundAField) {
  const Text t = text("x,y\n\" 1 \",\"\" 2\" \"\n");
  CsvReader csv(t, {{"x", "y"}, {}});
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.field(kX), "1");
  EXPECT_EQ(csv.field(kY), "2");
}

TEST(Csv, KeepsCommasBetweenQuotes) {
  const Text t = text("x, \"y, in m\" ,z\n\"[1, 2]\",\",\" ,\"3,\"\n");
  CsvReader csv(t, {{"x", "y, in m", "z"}, {}});
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.field(0), "[1, 2]");
  EXPECT_EQ(csv.field(1), ",");
  EXPECT_EQ(csv.field(2), "3,");
}

TEST(Csv, TakesAQuoteThatIsNeverClosedLiterally) {
  const Text t = text("x,y,z\n\"1,2 \"m,\"\" 3\n");
  CsvReader csv(t, {{"x", "y", "z"}, {}});
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.field(0), "\"1");
  EXPECT_EQ(csv.field(1), "2 \"m");
  EXPECT_EQ(csv.field(2), "\"\" 3");
}

TEST(Csv, NumbersAllColumnsIfNoneIsNamed) {
  const Text t = text("a,b,a\n1,2,3\n");
  CsvReader csv(t);
  EXPECT_EQ(csv.names(), (std::vector<std::string_view>{"a", "b", "a"}));
  EXPECT_EQ(csv.column("b"), 1u);
  expect_refusal([&] { csv.column("c"); }, 1, "the column 'c' is missing");
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.number(2), 3);
}

TEST(Csv, TakesAnOptionalColumn) {
  const Text t = text("extra,y,x\n7,2,1\n");
  CsvReader csv(t, {{"x", "y"}, {"extra"}});
  ASSERT_TRUE(csv.next());
  ASSERT_TRUE(csv.has(kExtra));
  EXPECT_EQ(csv.number(kExtra), 7);
}

void expect_table_refused(const std::string& content, std::size_t line, const std::string& words) {
  expect_refusal(
      [&] {
        const Text t = text(content);
        CsvReader csv(t, {{"x", "y"}, {}});
        while (csv.next()) {
          csv.coordinate(kX);
          csv.sigma(kY);
        }
      },
      line, words);
}

TEST(Csv, RefusesHeadersThatDoNotFit) {
  expect_table_refused("x,z\n1,2\n", 1, "the column 'y' is missing");
  expect_table_refused("1,2\n", 1, "the column 'x' is missing");
  expect_table_refused("x,y,x\n1,2,3\n", 1, "twice");
  expect_table_refused("\n", 1, "no header");
  expect_table_refused("", 1, "empty");
}

TEST(Csv, RefusesRowsThatDoNotFit) {
  expect_table_refused("x,y\n1,2\n1\n", 3, "the row has 1 fields, but the header 2");
  expect_table_refused("x,y\n1,2,3\n", 2, "the row has 3 fields");
  expect_table_refused("x,y\n1,2\n1", 3, "the file ends in this line");
  expect_table_refused("x,y\n,2\n", 2, "x '' is not a finite number");
  expect_table_refused("x,y\n1e9,2\n", 2, "x '1e9'");
  expect_table_refused("x,y\n1,-2\n", 2, "y '-2' is negative");
}

WifiRecordings wifi(const std::vector<std::string>& contents) {
  std::vector<Text> texts;
  for (const auto& content : contents) texts.push_back(text(content));
  return read_wifi(texts);
}
const std::string kHeader = "t_s,bssid,frequency_mhz,rssi_dbm\n";

TEST(ReadWifi, GathersScansAndSharesAccessPoints) {
  const auto recordings =
      wifi({kHeader + "2,bb,2412,-60\n1.5,AA,5180,-50.5\n2,Aa,2437,-70\n", kHeader + "1,BB,2412,-40\n"});
  EXPECT_EQ(recordings.access_points, (std::vector<std::string>{"aa", "bb"}));
  ASSERT_EQ(recordings.receivers.size(), 2u);
  const auto& scans = recordings.receivers[0];
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0].stamp.ns, 1'500'000'000);
  EXPECT_EQ(scans[0].readings[0].rssi_dbm, -50.5f);
  ASSERT_EQ(scans[1].readings.size(), 2u);
  EXPECT_EQ(scans[1].readings[0].access_point, AccessPointIndex(0));
  EXPECT_EQ(scans[1].readings[1].access_point, AccessPointIndex(1));
  EXPECT_EQ(recordings.receivers[1][0].readings[0].access_point, AccessPointIndex(1));
}

TEST(ReadWifi, DoesNotDependOnTheOrderOfRows) {
  const std::string a = "1,aa,2412,-60\n", b = "1,aa,2412,-50\n", c = "2,bb,2412,-50\n";
  const auto written = [](const WifiRecordings& r) { return format_wifi(r.receivers[0], r.access_points); };
  const std::string expected = kHeader + b + c;
  EXPECT_EQ(written(wifi({kHeader + a + b + c})), expected);
  EXPECT_EQ(written(wifi({kHeader + c + b + a})), expected);
}

TEST(ReadWifi, CountsWhatOneReceiverSpellsOtherwise) {
  const std::string colons = kHeader + "1,02:00:00:00:00:0a,2412,-60\n1,02:00:00:00:00:0b,2412,-60\n";
  const std::string dashes = kHeader + "1,02-00-00-00-00-0A,2412,-50\n1,02-00-00-00-00-0C,2412,-60\n";
  const auto recordings = wifi({colons, dashes});
  EXPECT_EQ(recordings.access_points,
            (std::vector<std::string>{"02:00:00:00:00:0a", "02:00:00:00:00:0b", "02:00:00:00:00:0c"}));
  EXPECT_EQ(recordings.receivers[1][0].readings[0].access_point, AccessPointIndex(0));
  EXPECT_EQ(recordings.respelled[0].count, 0u);
  EXPECT_EQ(recordings.respelled[1].count, 1u);
  EXPECT_EQ(recordings.respelled[1].example, "02-00-00-00-00-0A");
  for (const auto& alike : {wifi({colons, colons}), wifi({dashes, dashes})})
    for (const Respelled& respelled : alike.respelled) EXPECT_EQ(respelled.count, 0u);
}

TEST(ReadWifi, AcceptsAReceiverWithoutScans) { EXPECT_TRUE(wifi({kHeader}).receivers[0].empty()); }

TEST(ReadWifi, RefusesWhatNoReceiverReports) {
  const auto refused = [](const std::string& rows, std::size_t line, const std::string& words) {
    expect_refusal([&] { wifi({kHeader + rows}); }, line, words);
  };
  refused("1,aa,2412,-60\n1,bb,2412,-151\n", 3, "outside -150 to 30");
  refused("1,aa,2412,31\n", 2, "outside -150 to 30");
  refused("1,,2412,-60\n", 2, "the bssid is empty");
  refused("1,aa,-1,-60\n", 2, "negative");
  refused("1,aa,2412,nan\n", 2, "rssi_dbm 'nan'");
  refused("nan,aa,2412,-60\n", 2, "t_s 'nan'");
  refused("1,aa,2412\n", 2, "3 fields");
}

}  // namespace
}  // namespace radioslam
