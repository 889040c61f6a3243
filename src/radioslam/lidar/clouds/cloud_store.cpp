#include "radioslam/lidar/clouds/cloud_store.hpp"

#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "radioslam/base/scratch_file.hpp"
#include "radioslam/lidar/clouds/packed_cloud.hpp"

namespace radioslam {
namespace {

std::size_t bytes_of(const ScanPyramid& cloud) {
  return sizeof(ScanPyramid) + sizeof(Surfel) * (cloud.all.capacity() + cloud.source.surfels.capacity() +
                                                 cloud.few.surfels.capacity());
}

}  // namespace

/// What the clouds of a store share: the bound, the file, and the clouds that were read last.
class CloudStore::Shelf {
 public:
  explicit Shelf(const CloudStoreParams& params)
      : most_bytes_((static_cast<std::size_t>(params.memory_mib) << 20U) / 2),
        file_("more room there, TMPDIR=FOLDER or a higher clouds.memory_mib helps") {}

  ScratchFile& file() { return file_; }
  std::uint64_t next_key() {
    const std::lock_guard lock(mutex_);
    return next_key_++;
  }

  /// Whether so many packed bytes more stay in memory.
  bool takes(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    if (packed_bytes_ + bytes > most_bytes_) return false;
    packed_bytes_ += bytes;
    return true;
  }
  void give_back(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    packed_bytes_ -= bytes;
  }

  std::shared_ptr<const ScanPyramid> recent(std::uint64_t key) {
    const std::lock_guard lock(mutex_);
    const auto found = recent_of_.find(key);
    if (found == recent_of_.end()) return nullptr;
    recent_.splice(recent_.begin(), recent_, found->second);
    return found->second->second;
  }

  void keep(std::uint64_t key, std::shared_ptr<const ScanPyramid> cloud) {
    const std::lock_guard lock(mutex_);
    if (recent_of_.contains(key)) return;
    recent_bytes_ += bytes_of(*cloud);
    recent_.emplace_front(key, std::move(cloud));
    recent_of_[key] = recent_.begin();
    while (recent_bytes_ > most_bytes_) {
      recent_bytes_ -= bytes_of(*recent_.back().second);
      recent_of_.erase(recent_.back().first);
      recent_.pop_back();
    }
  }

 private:
  using Recent = std::list<std::pair<std::uint64_t, std::shared_ptr<const ScanPyramid>>>;

  std::size_t most_bytes_;  ///< of packed clouds, and of unpacked ones
  ScratchFile file_;
  std::mutex mutex_;
  std::uint64_t next_key_ = 0;
  std::size_t packed_bytes_ = 0, recent_bytes_ = 0;
  Recent recent_;  ///< the last read first
  std::unordered_map<std::uint64_t, Recent::iterator> recent_of_;
};

/// Of one cloud, in memory or in the file.
class StoredCloud::Bytes {
 public:
  Bytes(std::shared_ptr<CloudStore::Shelf> shelf, std::string bytes)
      : shelf_(std::move(shelf)), key_(shelf_->next_key()), size_(bytes.size()) {
    if (shelf_->takes(size_))
      in_memory_ = std::move(bytes);
    else
      begin_ = shelf_->file().append(bytes);
  }
  ~Bytes() {
    if (in_memory_) shelf_->give_back(size_);
  }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;

  std::shared_ptr<const ScanPyramid> cloud() const {
    if (auto kept = shelf_->recent(key_)) return kept;
    auto cloud = std::make_shared<const ScanPyramid>(unpacked(in_memory_ ? *in_memory_ : read()));
    shelf_->keep(key_, cloud);
    return cloud;
  }

 private:
  std::string read() const {
    std::string bytes(size_, '\0');
    shelf_->file().read(begin_, bytes);
    return bytes;
  }

  std::shared_ptr<CloudStore::Shelf> shelf_;
  std::uint64_t key_;
  std::size_t size_;
  std::optional<std::string> in_memory_;
  std::uint64_t begin_ = 0;  ///< in the file
};

std::shared_ptr<const ScanPyramid> StoredCloud::read() const {
  static const auto kEmpty = std::make_shared<const ScanPyramid>();
  return bytes_ ? bytes_->cloud() : kEmpty;
}

CloudStore::CloudStore(const CloudStoreParams& params) : shelf_(std::make_shared<Shelf>(params)) {}

StoredCloud CloudStore::add(const ScanPyramid& cloud) {
  StoredCloud stored;
  stored.points_ = cloud.all.size();
  stored.median_range_m_ = cloud.median_range_m;
  if (!stored.empty()) stored.bytes_ = std::make_shared<const StoredCloud::Bytes>(shelf_, packed(cloud));
  return stored;
}

}  // namespace radioslam
