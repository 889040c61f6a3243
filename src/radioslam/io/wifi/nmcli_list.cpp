#include "radioslam/io/wifi/nmcli_list.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

constexpr int kFullSignal = 100;
constexpr int kStrongestLevel_dbm = -40, kLevels_db = 60;
constexpr double kHighestCarrier_mhz = 1e6;
constexpr std::string_view kMhzUnit = " MHz";
constexpr const char* kInexact =
    "values of SIGNAL do not correspond to a whole dBm; the nearest level is used";
constexpr const char* kClipped = "values of SIGNAL are 0 or 100: -100 dBm or weaker, -40 dBm or stronger";

/// NetworkManager's conversion of whole dB below -40 dBm to SIGNAL.
int nmcli_signal_of(int below_db) { return kFullSignal - kFullSignal * below_db / kLevels_db; }

/// Positions of the fields that are read.
struct NmcliColumns {
  explicit NmcliColumns(const std::vector<std::string>& fields) : count(fields.size()) {
    const auto find = [&](const char* name) -> std::optional<std::size_t> {
      const auto place = std::find(fields.begin(), fields.end(), name);
      if (place == fields.end()) return std::nullopt;
      return static_cast<std::size_t>(place - fields.begin());
    };
    bssid = *find("BSSID");
    signal = *find("SIGNAL");
    frequency = find("FREQ");
    channel = find("CHAN");
  }

  std::size_t count = 0, bssid = 0, signal = 0;
  std::optional<std::size_t> frequency, channel;
};

std::vector<std::string> split_escaped(std::string_view line) {
  std::vector<std::string> fields(1);
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == ':')
      fields.emplace_back();
    else
      fields.back() += line[k] == '\\' && k + 1 < line.size() ? line[++k] : line[k];
  }
  return fields;
}

/// One row of a list.
class NmcliRow {
 public:
  NmcliRow(const TextLines& at, const NmcliColumns& columns)
      : at_(at), columns_(columns), fields_(split_escaped(at.line())) {
    if (fields_.size() != columns.count)
      at.fail("the row has " + std::to_string(fields_.size()) + " fields, but --fields names " +
              std::to_string(columns.count));
  }

  std::string bssid() const {
    const std::string& text = fields_[columns_.bssid];
    const auto bssid = parse_bssid(text);
    if (!bssid) at_.fail(quoted_bytes(text) + " is not a valid BSSID");
    return *bssid;
  }

  int signal() const {
    const std::string& text = fields_[columns_.signal];
    const auto value = parse_integer(text);
    if (!value || *value < 0 || *value > kFullSignal)
      at_.fail(quoted_bytes(text) + " is not a SIGNAL from 0 to 100");
    return static_cast<int>(*value);
  }

  double frequency_mhz() const {
    if (!columns_.frequency) return frequency_of_channel_mhz();
    std::string_view text = fields_[*columns_.frequency];
    if (text.ends_with(kMhzUnit)) text.remove_suffix(kMhzUnit.size());
    const auto mhz = parse_number(text);
    if (!mhz || *mhz < 0 || *mhz > kHighestCarrier_mhz)
      at_.fail(quoted_bytes(text) + " is not a FREQ in MHz");
    return *mhz;
  }

 private:
  double frequency_of_channel_mhz() const {
    if (!columns_.channel) return 0;
    const auto channel = parse_integer(fields_[*columns_.channel]);
    if (!channel) at_.fail(quoted_bytes(fields_[*columns_.channel]) + " is not a valid CHAN");
    return carrier_of_channel_hz(*channel).value_or(0) / kHzPerMhz;
  }

  const TextLines& at_;
  const NmcliColumns& columns_;
  std::vector<std::string> fields_;
};

/// One row of the table for people. Of its columns, whose names and widths depend on the language and on the
/// version, BSSID, CHAN, RATE and SIGNAL are recognised by their form: a network's name may contain blanks,
/// but nothing behind SIGNAL has the form of the other three.
struct NmcliTableRow {
  std::string bssid;
  double frequency_mhz = 0;  ///< 0 if unknown
  int signal = 0;
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (line = trim(line); !line.empty(); line = trim(line)) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

/// The frequency from "11  65 Mbit/s  49", which are channel, rate and signal, or from "2462 MHz  65 MB/s 49"
/// of old versions; `end` is the place of the signal, at least 4. Nothing for other words.
std::optional<double> frequency_before_signal(const std::vector<std::string_view>& words, std::size_t end) {
  const auto signal = parse_integer(words[end]);
  const bool is_form = signal && *signal >= 0 && *signal <= kFullSignal &&
                       words[end - 1].find('/') != std::string_view::npos && parse_number(words[end - 2]);
  if (!is_form) return std::nullopt;
  if (words[end - 3] == "MHz") return parse_number(words[end - 4]);
  const auto channel = parse_integer(words[end - 3]);
  return channel ? std::optional(carrier_of_channel_hz(*channel).value_or(0) / kHzPerMhz) : std::nullopt;
}

/// Nothing for other lines.
std::optional<NmcliTableRow> table_row(std::string_view line) {
  constexpr std::size_t kWords = 4;
  const std::vector<std::string_view> words = words_of(line);
  const auto address = std::find_if(words.begin(), words.end(),
                                    [](std::string_view word) { return parse_bssid(word).has_value(); });
  const auto behind = static_cast<std::size_t>(address - words.begin()) + kWords;
  for (std::size_t end = words.size(); address != words.end() && end-- > behind;)
    if (const auto frequency_mhz = frequency_before_signal(words, end))
      return NmcliTableRow{*parse_bssid(*address), *frequency_mhz,
                           static_cast<int>(*parse_integer(words[end]))};
  return std::nullopt;
}

/// Whether a line is the head of the table for people.
bool is_table_head(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  return words.size() > 1 && (std::count(words.begin(), words.end(), "BSSID") > 0 ||
                              std::count(words.begin(), words.end(), "SSID") > 0);
}

constexpr const char* kForPeople =
    " of the table for people, which has no BSSID here, or other columns than BSSID, CHAN, RATE and SIGNAL; "
    "`nmcli -t -f BSSID,SSID-HEX,CHAN,FREQ,SIGNAL dev wifi list` prints rows that can be read";

/// Reads lists in either form.
class NmcliReader {
 public:
  NmcliReader(const Text& text, const std::vector<std::string>& fields) : lines_(text), columns_(fields) {}

  ScanListLog read(const Text& text) {
    while (lines_.next())
      if (lines_.line().find_first_not_of(" \t=-") != std::string_view::npos)
        skipped_.attempt([&] { read_line(); });
    skipped_.conclude(text.name, "row", log_.readings(), log_.warnings);
    foreign_.conclude(text.name, log_);
    if (log_.readings() == 0) text.fail(0, "contains no row of an nmcli list");
    return std::move(log_);
  }

 private:
  void read_line() {
    const bool is_row = split_escaped(lines_.line()).size() == columns_.count;
    if (auto list = is_row ? std::nullopt : list_at_time(lines_, log_, foreign_)) {
      log_.scans.push_back(std::move(*list));
    } else if (is_table_head(lines_.line())) {
      is_table_ = true;
    } else if (const auto row = table_row(lines_.line())) {
      add(row->bssid, row->frequency_mhz, row->signal);
    } else if (is_table_) {
      lines_.fail(quoted_bytes(trim(lines_.line())) + " is a row" + kForPeople);
    } else {
      const NmcliRow escaped(lines_, columns_);
      add(escaped.bssid(), escaped.frequency_mhz(), escaped.signal());
    }
  }

  void add(const std::string& bssid, double frequency_mhz, int signal) {
    const NmcliLevel level = level_of_nmcli_signal(signal);
    if (!level.exact) ++log_.counts[kInexact];
    if (signal == 0 || signal == kFullSignal) ++log_.counts[kClipped];
    if (log_.scans.empty()) log_.scans.push_back({lines_.number(), std::nullopt, {}, {}});
    log_.scans.back().readings.push_back({bssid, frequency_mhz, level.rssi_dbm, 0, std::nullopt});
  }

  TextLines lines_;
  NmcliColumns columns_;
  ScanListLog log_;
  SkippedRecords skipped_;
  ForeignLines foreign_;
  bool is_table_ = false;  ///< after the head of a table for people
};

}  // namespace

std::vector<std::string> default_nmcli_fields() { return {"BSSID", "SSID-HEX", "CHAN", "FREQ", "SIGNAL"}; }

std::vector<std::string> parse_nmcli_fields(const std::string& list) {
  std::vector<std::string> names(1);
  for (const char c : list) {
    if (c == ',')
      names.emplace_back();
    else
      names.back() += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  for (const char* name : {"BSSID", "SIGNAL"})
    if (std::count(names.begin(), names.end(), name) != 1)
      throw InputError("--fields " + list, 0, std::string(name) + " must appear exactly once");
  return names;
}

NmcliLevel level_of_nmcli_signal(int signal) {
  const int missing = kFullSignal - signal;
  const int below_db = (missing * kLevels_db + kFullSignal - 1) / kFullSignal;  // rounded up
  if (nmcli_signal_of(below_db) == signal) return {static_cast<double>(kStrongestLevel_dbm - below_db), true};
  return {kStrongestLevel_dbm - static_cast<double>(missing * kLevels_db) / kFullSignal, false};
}

ScanListLog read_nmcli_lists(const Text& text, const std::vector<std::string>& fields) {
  return NmcliReader(text, fields).read(text);
}

}  // namespace radioslam
