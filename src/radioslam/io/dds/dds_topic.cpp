#include "radioslam/io/dds/dds_topic.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <array>
#include <memory>
#include <tuple>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/input_error.hpp"
#include "radioslam/io/dds/dds_names.hpp"
#include "radioslam/io/dds/raw_type.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kBatch = 16;  // samples taken at once

bool is_plain_cdr(std::string_view bytes) {
  return bytes.size() >= 4 && bytes[0] == 0 && (bytes[1] == 0 || bytes[1] == 1);
}

using Qos = std::unique_ptr<dds_qos_t, void (*)(dds_qos_t*)>;

Qos make_qos(const DdsQos& values) {
  Qos qos(dds_create_qos(), &dds_delete_qos);
  const auto wait = static_cast<dds_duration_t>(values.longest_wait_s * 1e9);
  dds_qset_reliability(qos.get(), static_cast<dds_reliability_kind_t>(values.reliability), wait);
  dds_qset_durability(qos.get(), static_cast<dds_durability_kind_t>(values.durability));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, values.depth);
  if (values.durability != DdsDurability::kVolatile)  // without it a late reader gets the last sample alone
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, values.depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

DdsEntity checked(DdsEntity entity, const std::string& topic, const std::string& type) {
  if (entity >= 0) return entity;
  throw InputError("topic " + ros_topic(topic), 0,
                   "DDS refuses it with type " + ros_type(type) + ": " + dds_strretcode(entity));
}

/// A topic, and the type that it uses.
std::pair<DdsEntity, ddsi_sertype*> make_topic(const DdsDomain& domain, const std::string& name,
                                               const std::string& type) {
  ddsi_sertype* raw = make_raw_type(type);
  const DdsEntity topic =
      dds_create_topic_sertype(domain.participant(), name.c_str(), &raw, nullptr, nullptr, nullptr);
  if (topic < 0) ddsi_sertype_unref(raw);
  return {checked(topic, name, type), raw};
}

}  // namespace

DdsWriter::DdsWriter(DdsDomain& domain, const std::string& topic, const std::string& type,
                     const DdsQos& qos) {
  std::tie(topic_, type_) = make_topic(domain, topic, type);
  writer_ =
      checked(dds_create_writer(domain.participant(), topic_, make_qos(qos).get(), nullptr), topic, type);
}

DdsWriter::~DdsWriter() {
  dds_delete(writer_);
  dds_delete(topic_);
}

bool DdsWriter::write(std::string_view cdr) {
  RADIOSLAM_CHECK(is_plain_cdr(cdr),
                  "Cyclone's readers would wait forever for a sample of another encapsulation");
  return dds_writecdr(writer_, make_raw_sample(type_, cdr)) == DDS_RETCODE_OK;
}

std::size_t DdsWriter::matched() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer_, &status);
  return status.current_count;
}

bool DdsWriter::is_acknowledged() const { return dds_wait_for_acks(writer_, 0) == DDS_RETCODE_OK; }

DdsReader::DdsReader(DdsDomain& domain, const std::string& topic, const std::string& type, const DdsQos& qos,
                     Take take)
    : take_(std::move(take)) {
  topic_ = make_topic(domain, topic, type).first;
  const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(dds_create_listener(this),
                                                                            &dds_delete_listener);
  if (take_)
    dds_lset_data_available(listener.get(), [](dds_entity_t reader, void* self) noexcept {
      take_from(reader, static_cast<const DdsReader*>(self)->take_);
    });
  reader_ = checked(dds_create_reader(domain.participant(), topic_, make_qos(qos).get(), listener.get()),
                    topic, type);
}

DdsReader::~DdsReader() {
  dds_delete(reader_);
  dds_delete(topic_);
}

std::size_t DdsReader::take(const Take& take) { return take_from(reader_, take); }

std::size_t DdsReader::take_from(DdsEntity reader, const Take& take) {
  std::array<ddsi_serdata*, kBatch> samples{};
  std::array<dds_sample_info_t, kBatch> infos{};
  std::size_t taken = 0;
  for (;;) {
    const dds_return_t count =
        dds_takecdr(reader, samples.data(), kBatch, infos.data(),
                    DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ANY_INSTANCE_STATE);
    for (std::size_t k = 0; count > 0 && k < static_cast<std::size_t>(count); ++k) {
      if (infos[k].valid_data) {
        take({raw_bytes(samples[k]), Stamp{infos[k].source_timestamp}, infos[k].publication_handle});
        ++taken;
      }
      ddsi_serdata_unref(samples[k]);
    }
    if (count < static_cast<dds_return_t>(kBatch)) return taken;
  }
}

std::uint64_t DdsReader::lost() const {
  dds_sample_lost_status_t status{};
  dds_get_sample_lost_status(reader_, &status);
  return status.total_count;
}

std::size_t DdsReader::matched() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader_, &status);
  return status.current_count;
}

}  // namespace radioslam
