// A large array of numbers whose contents are not set: zeroing tens of megabytes that are about to be written
// costs as much as a good part of the arithmetic on them.
#pragma once

#include <cstddef>
#include <memory>

namespace radioslam {

/// Freed with itself; moved, not copied. Asks for large pages where the system has them.
class NumberStore {
 public:
  NumberStore() = default;
  explicit NumberStore(std::size_t size);

  double* data() { return values_.get(); }
  const double* data() const { return values_.get(); }
  std::size_t size() const { return size_; }

 private:
  struct Free {
    std::size_t alignment;
    void operator()(double* values) const;
  };
  std::unique_ptr<double[], Free> values_;
  std::size_t size_ = 0;
};

}  // namespace radioslam
