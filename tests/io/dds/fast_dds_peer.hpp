// A participant of another vendor's DDS that hands on raw CDR, on the loopback interface without multicast.
#pragma once

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <memory>
#include <string>
#include <vector>

namespace radioslam {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// std::string as a type: its bytes are the payload, encapsulation included.
class FastRawType : public fast::TopicDataType {
 public:
  explicit FastRawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 4U << 20U;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<std::string*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<const char*>(payload->data), payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<std::string*>(data)->size()); };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

class FastDdsPeer {
 public:
  explicit FastDdsPeer(std::uint32_t domain) {
    fast::DomainParticipantQos qos = fast::PARTICIPANT_QOS_DEFAULT;
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList = {"127.0.0.1"};
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    rtps::Locator_t own;
    rtps::IPLocator::setIPv4(own, "127.0.0.1");
    qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(own);
    qos.wire_protocol().default_unicast_locator_list.push_back(own);
    for (std::uint32_t participant = 0; participant < 6; ++participant) {
      own.port = 7400 + 250 * domain + 10 + 2 * participant;
      qos.wire_protocol().builtin.initialPeersList.push_back(own);
    }
    participant_ = fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
  }
  ~FastDdsPeer() {
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  FastDdsPeer(const FastDdsPeer&) = delete;
  FastDdsPeer& operator=(const FastDdsPeer&) = delete;

  /// `keeps`: late readers get what was sent before, as of /tf_static.
  void open_writer(const std::string& topic, const std::string& type, bool keeps = false) {
    fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    // As in ROS 2; Fast DDS keeps samples by default.
    qos.durability().kind = keeps ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
    qos.publish_mode().kind = fast::ASYNCHRONOUS_PUBLISH_MODE;
    qos.history().depth = 20;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    writer_ = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT)
                  ->create_datawriter(made(topic, type), qos);
  }
  void open_reader(const std::string& topic, const std::string& type) {
    fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 20;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    reader_ = participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)
                  ->create_datareader(made(topic, type), qos);
  }

  /// Readers that the writer, and writers that the reader has found.
  std::int32_t matched() const {
    fast::PublicationMatchedStatus published;
    fast::SubscriptionMatchedStatus subscribed;
    if (writer_ != nullptr) writer_->get_publication_matched_status(published);
    if (reader_ != nullptr) reader_->get_subscription_matched_status(subscribed);
    return published.current_count + subscribed.current_count;
  }
  bool write(std::string bytes) { return writer_->write(&bytes); }
  /// All that has arrived so far.
  const std::vector<std::string>& received() {
    std::string bytes;
    fast::SampleInfo info;
    while (reader_->take_next_sample(&bytes, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
      if (info.valid_data) received_.push_back(bytes);
    return received_;
  }

 private:
  fast::Topic* made(const std::string& topic, const std::string& type) {
    fast::TypeSupport support(new FastRawType(type));
    support.register_type(participant_);
    return participant_->create_topic(topic, type, fast::TOPIC_QOS_DEFAULT);
  }

  fast::DomainParticipant* participant_ = nullptr;
  fast::DataWriter* writer_ = nullptr;
  fast::DataReader* reader_ = nullptr;
  std::vector<std::string> received_;
};

}  // namespace radioslam
