#include "radioslam/io/dds/dds_domain.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <utility>

#include "radioslam/base/input_error.hpp"

namespace radioslam {
namespace {

constexpr std::uint32_t kFirstInnerDomain = 1000, kLastInnerDomain = 2000;
constexpr std::size_t kBatch = 32;  // announcements taken at once
constexpr std::size_t kMostReports = 100;
constexpr std::int64_t kReceiveBuffer = 1 << 20;  // bytes; Cyclone asks for as many

/// Cyclone's warnings and errors of the whole process, which it would print.
class Reports {
 public:
  static Reports& all() {
    static Reports reports;
    return reports;
  }
  std::vector<std::string> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(lines_, {});
  }

 private:
  Reports() { dds_set_log_sink(&Reports::add, this); }
  static void add(void* self, const dds_log_data_t* data) {
    auto& reports = *static_cast<Reports*>(self);
    std::string line(data->message, data->size);
    while (!line.empty() && (line.back() == '\n' || line.back() == '\0')) line.pop_back();
    std::replace(line.begin(), line.end(), '\n', ' ');
    const std::lock_guard lock(reports.mutex_);
    if (reports.lines_.size() < kMostReports) reports.lines_.push_back(std::move(line));
  }

  std::mutex mutex_;
  std::vector<std::string> lines_;
};

[[noreturn]] void refuse(const DdsConfig& config, const std::string& what, dds_return_t code) {
  std::string reason = what + ": " + dds_strretcode(code);
  for (const std::string& line : Reports::all().take()) reason += "; " + line;
  if (reason.find("free participant index") != std::string::npos)
    reason += "; robots of this host: at most " + std::to_string(config.robots_per_host);
  throw InputError("DDS domain " + std::to_string(config.domain), 0, reason);
}

/// What a report of Cyclone's has in common with others of its kind: its first words, without numbers.
std::string kind_of(const std::string& report) {
  constexpr int kWords = 5;
  std::string kind;
  int words = 0;
  for (const char c : report) {
    if (c == ' ' && ++words == kWords) break;
    if (c < '0' || c > '9') kind += c;
  }
  return kind;
}

/// Cyclone knows a domain once in a process; further ones of the same number have another one inside.
DdsEntity create_domain(const DdsConfig& config, const std::string& settings) {
  DdsEntity domain = dds_create_domain(config.domain, settings.c_str());
  for (std::uint32_t inner = kFirstInnerDomain;
       domain == DDS_RETCODE_PRECONDITION_NOT_MET && inner < kLastInnerDomain; ++inner)
    domain = dds_create_domain(inner, settings.c_str());
  if (domain < 0) refuse(config, "cannot be entered", domain);
  return domain;
}

/// The domain in which an entity has been created.
dds_domainid_t domain_number(DdsEntity domain) {
  dds_domainid_t number = 0;
  dds_get_domainid(domain, &number);
  return number;
}

void free_contents(dds_builtintopic_participant_t& announced) { dds_delete_qos(announced.qos); }

void free_contents(dds_builtintopic_endpoint_t& announced) {
  dds_free(announced.topic_name);
  dds_free(announced.type_name);
  dds_delete_qos(announced.qos);
}

/// Takes what has been announced since the last time; `made` gets what is there, `gone` the handle of what is
/// not. The memory is not Cyclone's: loans whose size grew between reads have damaged the heap (0.10.2).
template <class Announcement, class Made, class Gone>
void take_announced(DdsEntity reader, const Made& made, const Gone& gone) {
  constexpr std::uint32_t kAll = DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ANY_INSTANCE_STATE;
  for (;;) {
    std::array<Announcement, kBatch> announced{};
    std::array<void*, kBatch> pointers{};
    std::array<dds_sample_info_t, kBatch> infos{};
    std::transform(announced.begin(), announced.end(), pointers.begin(),
                   [](Announcement& one) { return &one; });
    const dds_return_t count = dds_take_mask(reader, pointers.data(), infos.data(), kBatch, kBatch, kAll);
    for (std::size_t k = 0; count > 0 && k < static_cast<std::size_t>(count); ++k) {
      if (infos[k].instance_state != DDS_ALIVE_INSTANCE_STATE)
        gone(infos[k].instance_handle);
      else if (infos[k].valid_data)
        made(infos[k].instance_handle, announced[k]);
    }
    for (Announcement& one : announced) free_contents(one);
    if (count < static_cast<dds_return_t>(kBatch)) return;
  }
}

std::array<std::uint8_t, 16> bytes_of(const dds_guid_t& guid) {
  std::array<std::uint8_t, 16> bytes{};
  std::copy(std::begin(guid.v), std::end(guid.v), bytes.begin());
  return bytes;
}

void read_qos(const dds_qos_t* qos, DdsEndpoint& endpoint) {
  dds_reliability_kind_t reliability{};
  dds_durability_kind_t durability{};
  dds_liveliness_kind_t liveliness{};
  dds_ownership_kind_t ownership{};
  dds_destination_order_kind_t order{};
  dds_duration_t duration = 0;
  if (dds_qget_reliability(qos, &reliability, &duration))
    endpoint.reliability = static_cast<DdsReliability>(reliability);
  if (dds_qget_durability(qos, &durability)) endpoint.durability = static_cast<DdsDurability>(durability);
  if (dds_qget_deadline(qos, &duration)) endpoint.deadline_ns = duration;
  if (dds_qget_liveliness(qos, &liveliness, &duration)) {
    endpoint.liveliness = static_cast<DdsLiveliness>(liveliness);
    endpoint.lease_ns = duration;
  }
  if (dds_qget_ownership(qos, &ownership)) endpoint.ownership = static_cast<DdsOwnership>(ownership);
  if (dds_qget_destination_order(qos, &order)) endpoint.order = static_cast<DdsOrder>(order);
  std::uint32_t count = 0;
  dds_data_representation_id_t* representations = nullptr;
  if (dds_qget_data_representation(qos, &count, &representations) && representations != nullptr) {
    endpoint.representations.assign(representations, representations + count);
    dds_free(representations);
  }
}

void take_endpoints(DdsEntity reader, const std::array<std::uint8_t, 16>& own,
                    std::map<std::uint64_t, DdsEndpoint>& known) {
  take_announced<dds_builtintopic_endpoint_t>(
      reader,
      [&](std::uint64_t handle, const dds_builtintopic_endpoint_t& announced) {
        DdsEndpoint endpoint;
        endpoint.participant = bytes_of(announced.participant_key);
        endpoint.topic = announced.topic_name;
        endpoint.type = announced.type_name;
        endpoint.is_own = endpoint.participant == own;
        read_qos(announced.qos, endpoint);
        known[handle] = std::move(endpoint);
      },
      [&](std::uint64_t handle) { known.erase(handle); });
}

std::vector<DdsEndpoint> values(const std::map<std::uint64_t, DdsEndpoint>& known) {
  std::vector<DdsEndpoint> endpoints;
  for (const auto& [handle, endpoint] : known) endpoints.push_back(endpoint);
  return endpoints;
}

}  // namespace

DdsDomain::DdsDomain(const DdsConfig& config) {
  if (config.domain > kLastDdsDomain || config.robots_per_host == 0)
    throw InputError(
        "DDS domain " + std::to_string(config.domain), 0,
        "the domain must be at most " + std::to_string(kLastDdsDomain) + ", the robots per host at least 1");
  Reports::all();
  const char* uri = std::getenv("CYCLONEDDS_URI");
  domain_ =
      create_domain(config, cyclone_config(config, uri ? std::optional<std::string>(uri) : std::nullopt));
  participant_ = dds_create_participant(domain_number(domain_), nullptr, nullptr);
  if (participant_ < 0) {
    dds_delete(domain_);
    refuse(config, "cannot be entered", participant_);
  }
  dds_guid_t guid{};
  dds_get_guid(participant_, &guid);
  guid_ = bytes_of(guid);
  all_participants_ = dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
  all_writers_ = dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  all_readers_ = dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, nullptr);
  note_settings(config, uri != nullptr && *uri != '\0');
}

DdsDomain::~DdsDomain() { dds_delete(domain_); }

void DdsDomain::note_settings(const DdsConfig& config, bool has_uri) {
  if (has_uri)
    pending_.push_back("DDS: CYCLONEDDS_URI is set; where it differs from this program, it prevails");
  if (config.discovery == DdsDiscovery::kPeers && config.peers.empty())
    pending_.push_back("DDS: no peers are listed and multicast is off; this robot finds nobody by itself");
  std::int64_t most = kReceiveBuffer;
  std::ifstream("/proc/sys/net/core/rmem_max") >> most;
  if (most < kReceiveBuffer)
    pending_.push_back(
        "DDS: the kernel buffers at most " + std::to_string(most) +
        " bytes of what arrives, large messages may be lost; sysctl -w net.core.rmem_max=4194304");
}

std::vector<std::string> DdsDomain::take_notes() {
  for (const std::string& line : Reports::all().take())
    if (known_.insert(kind_of(line)).second) pending_.push_back("DDS: " + line.substr(0, line.find(" <")));
  const auto readers = this->readers();
  for (const DdsEndpoint& writer : writers())
    for (const DdsEndpoint& reader : readers) {
      const std::string line = mismatch(writer, reader);
      if (!line.empty()) pending_.push_back("DDS: " + line);
    }
  std::vector<std::string> notes;
  for (std::string& line : std::exchange(pending_, {}))
    if (known_.insert(line).second) notes.push_back(std::move(line));
  return notes;
}

std::vector<DdsEndpoint> DdsDomain::writers() {
  take_endpoints(all_writers_, guid_, known_writers_);
  return values(known_writers_);
}

std::vector<DdsEndpoint> DdsDomain::readers() {
  take_endpoints(all_readers_, guid_, known_readers_);
  return values(known_readers_);
}

std::size_t DdsDomain::others() {
  take_announced<dds_builtintopic_participant_t>(
      all_participants_,
      [&](std::uint64_t handle, const dds_builtintopic_participant_t& announced) {
        if (bytes_of(announced.key) != guid_) others_.insert(handle);
      },
      [&](std::uint64_t handle) { others_.erase(handle); });
  return others_.size();
}

}  // namespace radioslam
