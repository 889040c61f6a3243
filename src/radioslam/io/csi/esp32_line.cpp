#include "radioslam/io/csi/esp32_line.hpp"

#include <algorithm>
#include <limits>

#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kDataMark = "CSI_DATA,", kHeaderMark = "type,";
/// Number of values that ESP32-CSI-Tool prints if it is built for the legacy training field only.
constexpr std::size_t kValuesOfLegacyField = 128;

constexpr std::string_view kToolHeader =
    "type,role,mac,rssi,rate,sig_mode,mcs,bandwidth,smoothing,not_sounding,aggregation,stbc,fec_coding,sgi,"
    "noise_floor,ampdu_cnt,channel,secondary_channel,local_timestamp,ant,sig_len,rx_state,real_time_set,"
    "real_timestamp,len";
constexpr std::string_view kEspressifHeader =
    "type,id,mac,rssi,rate,sig_mode,mcs,bandwidth,smoothing,not_sounding,aggregation,stbc,fec_coding,sgi,"
    "noise_floor,ampdu_cnt,channel,secondary_channel,local_timestamp,ant,sig_len,rx_state,len,first_word";

/// Splits a text at commas.
std::vector<std::string> split_at_commas(std::string_view text) {
  std::vector<std::string> fields;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = text.find(',');
    fields.emplace_back(trim(text.substr(0, comma)));
    if (comma != std::string_view::npos) text.remove_prefix(comma + 1);
  }
  return fields;
}

/// The fields before the values, by name.
class Esp32Fields {
 public:
  Esp32Fields(const TextLines& at, std::string_view text, const Esp32Columns& columns)
      : at_(at), fields_(split_at_commas(text)), names_(columns.names(at, fields_.size())) {
    if (!find("secondary_channel"))
      at_.fail(
          "the columns of an ESP32-C5 or -C6 are not supported: they do not define the order of the "
          "subcarriers");
  }

  std::optional<std::string_view> find(std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return std::nullopt;
    return fields_[static_cast<std::size_t>(found - names_.begin())];
  }
  std::string_view text(std::string_view name) const {
    const auto field = find(name);
    if (!field) at_.fail("column " + std::string(name) + " is missing");
    return *field;
  }
  std::int64_t number(std::string_view name, std::int64_t least, std::int64_t most) const {
    const auto value = parse_integer(text(name));
    if (!value || *value < least || *value > most)
      at_.fail(std::string(name) + " '" + std::string(text(name)) + "' is not a whole number from " +
               std::to_string(least) + " to " + std::to_string(most));
    return *value;
  }
  bool flag(std::string_view name) const { return number(name, 0, 1) == 1; }
  int small(std::string_view name, std::int64_t least, std::int64_t most) const {
    return static_cast<int>(number(name, least, most));
  }

 private:
  const TextLines& at_;
  std::vector<std::string> fields_;
  const std::vector<std::string>& names_;
};

std::vector<std::int8_t> read_values(const TextLines& at, std::string_view list) {
  constexpr std::string_view kBetween = ", ";
  std::vector<std::int8_t> values;
  while (true) {
    const std::size_t first = list.find_first_not_of(kBetween);
    if (first == std::string_view::npos) return values;
    list.remove_prefix(first);
    const std::string_view token = list.substr(0, list.find_first_of(kBetween));
    const auto value = parse_integer(token);
    if (!value || *value < std::numeric_limits<std::int8_t>::min() ||
        *value > std::numeric_limits<std::int8_t>::max())
      at.fail("value '" + std::string(token) + "' is not a whole number from -128 to 127");
    values.push_back(static_cast<std::int8_t>(*value));
    list.remove_prefix(token.size());
  }
}

MacAddress read_sender(const TextLines& at, std::string_view text) {
  const auto address = parse_mac_address(text);
  if (!address) at.fail("'" + std::string(text) + "' is not a MAC address such as 00:21:6a:3f:17:5a");
  return *address;
}

/// An unsigned number that the chip may have printed as a signed one.
std::uint32_t wrapping_number(const Esp32Fields& fields, std::string_view name) {
  return static_cast<std::uint32_t>(fields.number(name, std::numeric_limits<std::int32_t>::min(),
                                                  std::numeric_limits<std::uint32_t>::max()));
}

void read_times(const TextLines& at, const Esp32Fields& fields, Esp32Packet& packet) {
  packet.clock_us = wrapping_number(fields, "local_timestamp");
  if (fields.find("id")) packet.counter = wrapping_number(fields, "id");
  if (!fields.find("real_time_set") || !fields.flag("real_time_set")) return;
  packet.host_stamp = parse_stamp(fields.text("real_timestamp"));
  if (!packet.host_stamp)
    at.fail("real_timestamp '" + std::string(fields.text("real_timestamp")) + "' is not a valid time");
}

Esp32Packet read_fields(const TextLines& at, const Esp32Fields& fields) {
  constexpr int kNonHt = 0, kHt = 1, kMaxChannels = 255, kMaxValues = 65535;
  Esp32Packet packet;
  packet.sender = read_sender(at, fields.text("mac"));
  packet.rssi_dbm = fields.small("rssi", -128, 127);
  packet.noise_dbm = fields.small("noise_floor", -128, 127);
  packet.is_high_throughput = fields.number("sig_mode", kNonHt, kHt) == kHt;
  packet.is_wide = fields.flag("bandwidth");
  packet.is_stbc = fields.number("stbc", 0, 3) != 0;
  packet.channel = fields.small("channel", 0, kMaxChannels);
  packet.secondary = static_cast<SecondaryChannel>(fields.number("secondary_channel", 0, 2));
  packet.values_stated = static_cast<std::size_t>(fields.number("len", 0, kMaxValues));
  if (fields.find("first_word")) packet.is_first_word_invalid = fields.flag("first_word");
  read_times(at, fields, packet);
  return packet;
}

}  // namespace

bool Esp32Columns::take_header(std::string_view line) {
  const std::size_t begin = line.find(kHeaderMark);
  if (begin == std::string_view::npos || line.find("local_timestamp", begin) == std::string_view::npos)
    return false;
  header_ = split_at_commas(line.substr(begin));
  header_.pop_back();  // the values
  return true;
}

const std::vector<std::string>& Esp32Columns::names(const TextLines& at, std::size_t fields) const {
  static const std::vector<std::string> tool = split_at_commas(kToolHeader);
  static const std::vector<std::string> espressif = split_at_commas(kEspressifHeader);
  for (const auto* known : {&header_, &tool, &espressif})
    if (known->size() == fields) return *known;
  at.fail(std::to_string(fields) + " fields before the values, but " +
          (header_.empty() ? "25 (ESP32-CSI-Tool) or 24 (esp-csi) are expected"
                           : "the header has " + std::to_string(header_.size())));
}

std::size_t esp32_data_begin(std::string_view line) { return line.rfind(kDataMark); }

Esp32Packet read_esp32_line(const TextLines& at, const Esp32Columns& columns) {
  const std::string_view line = at.line().substr(esp32_data_begin(at.line()));
  const std::size_t open = line.find('['), close = line.find(']', open);
  if (open == std::string_view::npos) at.fail("the list of values is missing");
  if (close == std::string_view::npos) at.fail("the list of values is not closed");
  std::string_view before = line.substr(0, open);
  if (before.ends_with('"')) before.remove_suffix(1);
  if (!before.ends_with(',')) at.fail("a comma is missing before the list of values");
  before.remove_suffix(1);
  Esp32Packet packet = read_fields(at, Esp32Fields(at, before, columns));
  packet.values = read_values(at, line.substr(open + 1, close - open - 1));
  const bool is_shortened =
      packet.values_stated > kValuesOfLegacyField && packet.values.size() == kValuesOfLegacyField;
  if (packet.values.size() != packet.values_stated && !is_shortened)
    at.fail(std::to_string(packet.values.size()) + " values, but len is " +
            std::to_string(packet.values_stated));
  return packet;
}

}  // namespace radioslam
