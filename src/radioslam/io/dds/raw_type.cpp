#include "radioslam/io/dds/raw_type.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>

namespace radioslam {
namespace {

constexpr std::size_t kAlignment = 4;  // the protocol reads a sample's bytes up to a multiple

/// Bytes on their way from a writer or to a reader. Without a key, all samples are of one instance.
struct RawSample : ddsi_serdata {
  std::string bytes;  ///< padded to kAlignment
  std::size_t size = 0;
};

const RawSample& as_raw(const ddsi_serdata* sample) { return *static_cast<const RawSample*>(sample); }

RawSample* new_sample(const ddsi_sertype* type, ddsi_serdata_kind kind) {
  auto* sample = new RawSample;
  ddsi_serdata_init(sample, type, kind);
  sample->hash = type->serdata_basehash;
  return sample;
}

void finish(RawSample& sample) {
  sample.size = sample.bytes.size();
  sample.bytes.resize((sample.size + kAlignment - 1) / kAlignment * kAlignment, '\0');
}

bool same_key(const ddsi_serdata*, const ddsi_serdata*) { return true; }

std::uint32_t size_of(const ddsi_serdata* sample) { return static_cast<std::uint32_t>(as_raw(sample).size); }

/// From the fragments of a message, which may overlap.
ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                             std::size_t size) {
  RawSample* sample = new_sample(type, kind);
  std::string& bytes = sample->bytes;
  bytes.reserve(size + kAlignment);
  for (; fragment != nullptr && bytes.size() < size; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= bytes.size() || fragment->min > bytes.size()) continue;
    const unsigned char* payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    const std::size_t known = bytes.size() - fragment->min;
    const std::size_t added = std::min<std::size_t>(fragment->maxp1, size) - bytes.size();
    bytes.append(reinterpret_cast<const char*>(payload) + known, added);
  }
  finish(*sample);
  return sample;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                          const ddsrt_iovec_t* pieces, std::size_t size) {
  RawSample* sample = new_sample(type, kind);
  for (ddsrt_msg_iovlen_t k = 0; k < count && sample->bytes.size() < size; ++k)
    sample->bytes.append(static_cast<const char*>(pieces[k].iov_base),
                         std::min<std::size_t>(pieces[k].iov_len, size - sample->bytes.size()));
  finish(*sample);
  return sample;
}

ddsi_serdata* from_key(const ddsi_sertype* type, const ddsi_keyhash*) { return new_sample(type, SDK_KEY); }

/// Only raw bytes are written.
ddsi_serdata* from_structure(const ddsi_sertype*, ddsi_serdata_kind, const void*) { return nullptr; }

void copy_bytes(const ddsi_serdata* sample, std::size_t offset, std::size_t size, void* out) {
  std::memcpy(out, as_raw(sample).bytes.data() + offset, size);
}

ddsi_serdata* lend_bytes(const ddsi_serdata* sample, std::size_t offset, std::size_t size,
                         ddsrt_iovec_t* out) {
  out->iov_base = const_cast<char*>(as_raw(sample).bytes.data() + offset);  // Cyclone only reads it
  out->iov_len = static_cast<ddsrt_iov_len_t>(size);
  return ddsi_serdata_ref(sample);
}

void take_back(ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); }

bool to_structure(const ddsi_serdata*, void*, void**, void*) { return false; }

ddsi_serdata* to_untyped(const ddsi_serdata* sample) {
  RawSample* key = new_sample(sample->type, SDK_KEY);
  key->type = nullptr;
  return key;
}

bool untyped_to_structure(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) { return true; }

void free_sample(ddsi_serdata* sample) { delete static_cast<RawSample*>(sample); }

std::size_t print(const ddsi_sertype*, const ddsi_serdata* sample, char* out, std::size_t size) {
  const std::string text = std::to_string(as_raw(sample).size) + " bytes";
  const std::size_t copied = std::min(text.size(), size - 1);
  text.copy(out, copied);
  out[copied] = '\0';
  return copied;
}

void get_key_hash(const ddsi_serdata*, ddsi_keyhash* out, bool) { std::memset(out, 0, sizeof(*out)); }

ddsi_serdata_ops sample_operations() {
  ddsi_serdata_ops operations{};
  operations.eqkey = same_key;
  operations.get_size = size_of;
  operations.from_ser = from_fragments;
  operations.from_ser_iov = from_pieces;
  operations.from_keyhash = from_key;
  operations.from_sample = from_structure;
  operations.to_ser = copy_bytes;
  operations.to_ser_ref = lend_bytes;
  operations.to_ser_unref = take_back;
  operations.to_sample = to_structure;
  operations.to_untyped = to_untyped;
  operations.untyped_to_sample = untyped_to_structure;
  operations.free = free_sample;
  operations.print = print;
  operations.get_keyhash = get_key_hash;
  return operations;
}

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete type;
}

ddsi_sertype_ops type_operations() {
  ddsi_sertype_ops operations{};
  operations.version = ddsi_sertype_v0;
  operations.free = free_type;
  operations.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  operations.realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {};
  operations.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  operations.equal = [](const ddsi_sertype*, const ddsi_sertype*) {
    return true;
  };  // names are compared before
  operations.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  return operations;
}

}  // namespace

ddsi_sertype* make_raw_type(const std::string& name) {
  static const ddsi_serdata_ops kSampleOperations = sample_operations();
  static const ddsi_sertype_ops kTypeOperations = type_operations();
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init_flags(type, name.c_str(), &kTypeOperations, &kSampleOperations,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

ddsi_serdata* make_raw_sample(const ddsi_sertype* type, std::string_view cdr) {
  RawSample* sample = new_sample(type, SDK_DATA);
  sample->bytes.reserve(cdr.size() + kAlignment);
  sample->bytes = cdr;
  finish(*sample);
  return sample;
}

std::string_view raw_bytes(const ddsi_serdata* sample) {
  const RawSample& raw = as_raw(sample);
  return std::string_view(raw.bytes).substr(0, raw.size);
}

}  // namespace radioslam
