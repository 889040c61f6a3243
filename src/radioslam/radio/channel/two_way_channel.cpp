#include "radioslam/radio/channel/two_way_channel.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <vector>

#include "radioslam/base/parabola.hpp"
#include "radioslam/base/stamp_intervals.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
DelayTable::DelayTable(const std::vector<double>& subcarrier_hz, double max_s, double step_s)
    : max_s_(max_s),
      step_s_(step_s),
      turns_(static_cast<Eigen::Index>(subcarrier_hz.size()),
             2 * static_cast<Eigen::Index>(std::ceil(max_s / step_s)) + 1) {
  for (Eigen::Index s = 0; s < turns_.rows(); ++s)
    for (Eigen::Index t = 0; t < turns_.cols(); ++t)
      turns_(s, t) =
          std::polar(1.0, 2 * std::numbers::pi * subcarrier_hz[static_cast<std::size_t>(s)] * delay_s(t));
}

double DelayTable::best_delay_s(const Eigen::RowVectorXcd& product) const {
  const Eigen::RowVectorXd size = (product * turns_).cwiseAbs();
  Eigen::Index best = 0;
  size.maxCoeff(&best);
  if (best == 0 || best + 1 == size.cols()) return delay_s(best);
  return delay_s(best) + step_s_ * parabola_peak(size[best - 1], size[best], size[best + 1]);
}

void advance(Eigen::Ref<Eigen::RowVectorXcd> row, const std::vector<double>& subcarrier_hz, double delay_s) {
  for (Eigen::Index s = 0; s < row.size(); ++s)
    row[s] *= std::polar(1.0, 2 * std::numbers::pi * subcarrier_hz[static_cast<std::size_t>(s)] * delay_s);
}

namespace {

void align_row(Eigen::MatrixXcd& channel, Eigen::Index k, const Eigen::RowVectorXcd& reference,
               const std::vector<double>& subcarrier_hz, const DelayTable& delays) {
  Eigen::RowVectorXcd row = channel.row(k);
  advance(row, subcarrier_hz, delays.best_delay_s(row.cwiseProduct(reference.conjugate())));
  channel.row(k) = row;
}

}  // namespace

void align_to_predecessors(Eigen::MatrixXcd& channel, const std::vector<double>& subcarrier_hz,
                           const DelayTable& delays, double newest_ratio) {
  Eigen::RowVectorXcd reference = Eigen::RowVectorXcd::Ones(channel.cols());
  for (Eigen::Index k = 0; k < channel.rows(); ++k) {
    align_row(channel, k, reference, subcarrier_hz, delays);
    const double size = channel.row(k).cwiseAbs().mean();
    if (size == 0) continue;
    const Eigen::RowVectorXcd unit = channel.row(k) / size;
    reference = k == 0 ? unit : Eigen::RowVectorXcd((1 - newest_ratio) * reference + newest_ratio * unit);
  }
}

void align_to_model(Eigen::MatrixXcd& channel, const std::vector<double>& subcarrier_hz,
                    const DelayTable& delays, const Eigen::MatrixXcd& model) {
  for (Eigen::Index k = 0; k < channel.rows(); ++k)
    align_row(channel, k, model.row(k), subcarrier_hz, delays);
}

namespace {

struct Link {
  float agreement;  ///< Re(h_a conj h_b)
  std::uint32_t a, b;
};

/// Disjoint sets of cells, each cell with its sign relative to the root of its set.
class SignedSets {
 public:
  explicit SignedSets(std::size_t count) : parent_(count), sign_(count, 1) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  /// Root of the cell's set, and the cell's sign relative to it.
  std::pair<std::uint32_t, signed char> find(std::uint32_t cell) {
    std::uint32_t root = cell;
    signed char sign = 1;
    for (; parent_[root] != root; root = parent_[root]) sign = static_cast<signed char>(sign * sign_[root]);
    const signed char whole = sign;
    while (parent_[cell] != root && cell != root) {
      const std::uint32_t next = parent_[cell];
      const auto rest = static_cast<signed char>(sign * sign_[cell]);
      parent_[cell] = root;
      sign_[cell] = sign;
      sign = rest;
      cell = next;
    }
    return {root, whole};
  }

  void join(const Link& link) {
    const auto [root_a, sign_a] = find(link.a);
    const auto [root_b, sign_b] = find(link.b);
    if (root_a == root_b) return;
    parent_[root_b] = root_a;
    sign_[root_b] = static_cast<signed char>((link.agreement >= 0 ? 1 : -1) * sign_a * sign_b);
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<signed char> sign_;  ///< relative to the parent
};

}  // namespace

Eigen::MatrixXcd square_root_channel(const Eigen::MatrixXcd& product) {
  Eigen::MatrixXcd h = product.cwiseSqrt();
  std::vector<Link> links;
  const auto cell = [&](Eigen::Index k, Eigen::Index s) {
    return static_cast<std::uint32_t>(k * h.cols() + s);
  };
  const auto link = [&](Eigen::Index k, Eigen::Index s, Eigen::Index later, Eigen::Index above) {
    if (k + later >= h.rows() || s + above >= h.cols()) return;
    links.push_back({static_cast<float>((h(k, s) * std::conj(h(k + later, s + above))).real()), cell(k, s),
                     cell(k + later, s + above)});
  };
  for (Eigen::Index k = 0; k < h.rows(); ++k)
    for (Eigen::Index s = 0; s < h.cols(); ++s) {
      link(k, s, 1, 0);
      link(k, s, 2, 0);
      link(k, s, 0, 1);
    }
  std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return std::abs(a.agreement) > std::abs(b.agreement);
  });
  SignedSets sets(static_cast<std::size_t>(h.size()));
  for (const Link& one : links) sets.join(one);
  for (Eigen::Index k = 0; k < h.rows(); ++k)
    for (Eigen::Index s = 0; s < h.cols(); ++s) h(k, s) *= sets.find(cell(k, s)).second;
  return h;
}

namespace {

constexpr std::size_t kMinExchanges = 3;
constexpr double kOffsetStep_hz = 100;
constexpr double kCounterStep_us = 1;
constexpr int kQuantileRounds = 20;
constexpr double kNominalPauses = 1.5;
constexpr std::size_t kMinTurns = 100;
constexpr double kChance = 0.01;

struct Exchange {
  const CsiPacket* heard;
  const CsiPacket* answer;
};

/// Packets by counter; null for a counter that occurs twice.
std::map<std::uint32_t, const CsiPacket*> by_counter(const CsiCapture& capture,
                                                     std::optional<MacAddress> sender) {
  std::map<std::uint32_t, const CsiPacket*> packets;
  for (const CsiPacket& packet : capture.packets) {
    if (!packet.counter || (sender && packet.sender != sender)) continue;
    const auto [entry, is_new] = packets.emplace(*packet.counter, &packet);
    if (!is_new) entry->second = nullptr;
  }
  return packets;
}

std::vector<Exchange> pair_up(const CsiCapture& receiver, MacAddress sender, const CsiCapture& answers) {
  const auto heard = by_counter(receiver, sender), back = by_counter(answers, std::nullopt);
  std::vector<Exchange> exchanges;
  for (const auto& [counter, packet] : heard) {
    const auto answer = back.find(counter);
    if (packet && answer != back.end() && answer->second) exchanges.push_back({packet, answer->second});
  }
  std::stable_sort(exchanges.begin(), exchanges.end(),
                   [](const Exchange& a, const Exchange& b) { return a.heard->stamp < b.heard->stamp; });
  exchanges.erase(
      std::unique(exchanges.begin(), exchanges.end(),
                  [](const Exchange& a, const Exchange& b) { return a.heard->stamp == b.heard->stamp; }),
      exchanges.end());
  return exchanges;
}

/// The receiver's clock minus the sender's, both unwrapped, relative to the first exchange.
std::vector<double> clock_differences_us(const std::vector<Exchange>& exchanges) {
  std::vector<double> difference{0};
  const auto step = [](const CsiPacket* from, const CsiPacket* to) {
    return std::int64_t{static_cast<std::int32_t>(to->clock_us - from->clock_us)};
  };
  for (std::size_t k = 1; k < exchanges.size(); ++k)
    difference.push_back(difference.back() +
                         static_cast<double>(step(exchanges[k - 1].heard, exchanges[k].heard) -
                                             step(exchanges[k - 1].answer, exchanges[k].answer)));
  return difference;
}

/// Residuals of the values from the polynomial in time that has a fraction `quantile` of them below it:
/// quantile regression by iteratively reweighted least squares.
std::vector<double> without_drift(const std::vector<double>& values, const std::vector<Exchange>& exchanges,
                                  int degree, double quantile) {
  const auto n = std::ssize(values);
  const Stamp first = exchanges.front().heard->stamp, last = exchanges.back().heard->stamp;
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(values.data(), n);
  Eigen::MatrixXd powers(n, degree + 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double t = 2 * seconds_between(first, exchanges[static_cast<std::size_t>(k)].heard->stamp) /
                         seconds_between(first, last) -
                     1;
    for (Eigen::Index d = 0; d <= degree; ++d) powers(k, d) = std::pow(t, static_cast<double>(d));
  }
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(n), residual = y;
  for (int round = 0; round < kQuantileRounds; ++round) {
    const Eigen::MatrixXd weighted = weight.asDiagonal() * powers;
    const Eigen::VectorXd fit =
        ldlt_solve<Eigen::MatrixXd>(weighted.transpose() * powers, weighted.transpose() * y);
    residual = y - powers * fit;
    for (Eigen::Index k = 0; k < n; ++k)
      weight[k] =
          (residual[k] > 0 ? quantile : 1 - quantile) / std::max(std::abs(residual[k]), kCounterStep_us);
  }
  return {residual.begin(), residual.end()};
}

/// The columns of the subcarriers nearest to the carrier.
std::vector<Eigen::Index> centre_columns(const std::vector<double>& subcarrier_hz, int count) {
  std::vector<Eigen::Index> columns(subcarrier_hz.size());
  std::iota(columns.begin(), columns.end(), Eigen::Index{0});
  std::stable_sort(columns.begin(), columns.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(subcarrier_hz[static_cast<std::size_t>(a)]) <
           std::abs(subcarrier_hz[static_cast<std::size_t>(b)]);
  });
  columns.resize(std::min(columns.size(), static_cast<std::size_t>(count)));
  return columns;
}

std::complex<double> mean_of(const CsiPacket& packet, const std::vector<Eigen::Index>& columns) {
  std::complex<double> sum = 0;
  for (const Eigen::Index k : columns) sum += std::complex<double>(packet.channel(0, k));
  return sum / static_cast<double>(columns.size());
}

/// Phase difference and jitter difference of two successive exchanges.
struct Turn {
  std::complex<double> phase;
  double jitter_us;
};

std::complex<double> derotated(std::complex<double> phase, double jitter_us, double offset_hz) {
  return phase * std::polar(1.0, -2 * std::numbers::pi * offset_hz * jitter_us * kSecondsPerMicrosecond);
}

double coherence(const std::vector<Turn>& turns, double offset_hz) {
  std::complex<double> sum = 0;
  for (const Turn& turn : turns) sum += derotated(turn.phase, turn.jitter_us, offset_hz);
  return turns.empty() ? 0 : std::abs(sum) / static_cast<double>(turns.size());
}

std::vector<Turn> successive_turns(const std::vector<Exchange>& exchanges, const std::vector<double>& jitter,
                                   const std::vector<std::complex<double>>& centres, double max_pause_s) {
  std::vector<Turn> turns;
  for (std::size_t k = 1; k < exchanges.size(); ++k) {
    const std::complex<double> turn = centres[k] * std::conj(centres[k - 1]);
    const bool near =
        seconds_between(exchanges[k - 1].heard->stamp, exchanges[k].heard->stamp) <= max_pause_s;
    if (near && std::abs(turn) > 0) turns.push_back({turn / std::abs(turn), jitter[k] - jitter[k - 1]});
  }
  return turns;
}

int frequencies_tried(double max_hz) { return 2 * static_cast<int>(max_hz / kOffsetStep_hz) + 1; }

/// Whether random phases reach this coherence too often for it to be significant.
bool is_chance(std::size_t turns, double coherence, int tried) {
  return tried * std::exp(-static_cast<double>(turns) * coherence * coherence) > kChance;
}

/// Offset of largest coherence. The phases are rotated from one offset to the next, and recomputed every 64
/// offsets so that rounding errors do not accumulate.
double frequency_offset_hz(const std::vector<Turn>& turns, double max_hz) {
  constexpr int kRecomputeEvery = 64;
  std::vector<std::complex<double>> steps, phases(turns.size());
  for (const Turn& turn : turns) steps.push_back(derotated(1, turn.jitter_us, kOffsetStep_hz));
  const int count = frequencies_tried(max_hz) / 2;
  double best_hz = 0, best = 0;
  for (int k = -count; k <= count; ++k) {
    const bool recompute = (k + count) % kRecomputeEvery == 0;
    double re = 0, im = 0;
    for (std::size_t t = 0; t < turns.size(); ++t) {
      const std::complex<double> here =
          recompute
              ? derotated(turns[t].phase, turns[t].jitter_us, k * kOffsetStep_hz)
              : std::complex<double>(phases[t].real() * steps[t].real() - phases[t].imag() * steps[t].imag(),
                                     phases[t].real() * steps[t].imag() + phases[t].imag() * steps[t].real());
      phases[t] = here;
      re += here.real();
      im += here.imag();
    }
    const double size = re * re + im * im;
    if (size <= best) continue;
    best = size;
    best_hz = k * kOffsetStep_hz;
  }
  return best_hz;
}

}  // namespace

TwoWayResult two_way_channel(const CsiCapture& receiver, MacAddress sender, const CsiCapture& answers,
                             const TwoWayParams& params) {
  std::vector<Exchange> exchanges = pair_up(receiver, sender, answers);
  if (exchanges.size() < kMinExchanges) return {};
  if (receiver.subcarrier_hz != answers.subcarrier_hz)
    return {std::nullopt, TwoWayFailure::kOtherSubcarriers};
  TwoWayChannel result;
  result.paired = exchanges.size();
  const std::vector<double> all_jitter =
      without_drift(clock_differences_us(exchanges), exchanges, params.drift_degree, params.undelayed_ratio);
  std::vector<double> jitter;
  std::vector<Exchange> accepted;
  for (std::size_t k = 0; k < exchanges.size(); ++k) {
    if (std::abs(all_jitter[k]) > params.max_jitter_us) continue;
    accepted.push_back(exchanges[k]);
    jitter.push_back(all_jitter[k]);
  }
  result.rejected = exchanges.size() - accepted.size();
  if (accepted.size() < kMinExchanges) return {};
  exchanges = std::move(accepted);

  const auto columns = centre_columns(receiver.subcarrier_hz, params.centre_subcarriers);
  std::vector<std::complex<double>> centres;
  for (const auto& [heard, answer] : exchanges)
    centres.push_back(mean_of(*heard, columns) * mean_of(*answer, columns));
  const auto stamp_of = [](const Exchange& exchange) { return exchange.heard->stamp; };
  const double nominal_s = kNominalPauses * median_interval_s(exchanges, stamp_of);
  const std::vector<Turn> turns =
      successive_turns(exchanges, jitter, centres, std::max(params.max_pause_s, nominal_s));
  const double best_hz = frequency_offset_hz(turns, params.max_offset_hz);
  const double best = coherence(turns, best_hz);
  const bool by_chance = is_chance(turns.size(), best, frequencies_tried(params.max_offset_hz));
  result.coherence_before = coherence(turns, 0);
  if (turns.size() >= kMinTurns) {
    result.coherence = best;
    if (by_chance || (nominal_s <= params.max_pause_s && best < params.min_coherence))
      return {std::nullopt, TwoWayFailure::kIncoherent};
  }
  if (!by_chance) result.frequency_offset_hz = best_hz;

  result.product.resize(static_cast<Eigen::Index>(exchanges.size()),
                        static_cast<Eigen::Index>(receiver.subcarrier_hz.size()));
  for (std::size_t k = 0; k < exchanges.size(); ++k) {
    const auto& [heard, answer] = exchanges[k];
    result.stamps.push_back(heard->stamp);
    result.product.row(static_cast<Eigen::Index>(k)) =
        heard->channel.row(0).cast<std::complex<double>>().cwiseProduct(
            answer->channel.row(0).cast<std::complex<double>>()) *
        derotated(1, jitter[k], result.frequency_offset_hz);
  }
  return {std::move(result), {}};
}

}  // namespace radioslam
