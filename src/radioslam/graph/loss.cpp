#include "radioslam/graph/loss.hpp"

#include <cmath>

namespace radioslam {

LossValue evaluate(const Loss& loss, double squared_norm) {
  const double s = squared_norm, c2 = loss.scale * loss.scale;
  switch (loss.kind) {
    case LossKind::kNone:
      return {s, 1};
    case LossKind::kHuber: {
      if (s <= c2) return {s, 1};
      const double norm = std::sqrt(s);
      return {2 * loss.scale * norm - c2, loss.scale / norm};
    }
    case LossKind::kCauchy:
      return {c2 * std::log1p(s / c2), c2 / (c2 + s)};
    case LossKind::kGemanMcClure: {
      const double ratio = c2 / (c2 + s);
      return {ratio * s, ratio * ratio};
    }
  }
  return {s, 1};
}

}  // namespace radioslam
