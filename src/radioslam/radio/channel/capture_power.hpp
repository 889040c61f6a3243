// Received power and effective SNR of a CSI capture: medians over its packets.
//
// An Intel 5300 reports RSSI as a positive number on its own scale, from which the received power and, with
// the measured noise, the SNR of every subcarrier follow. Other cards report negative
// dBm and no noise, which gives the power only. The effective SNR is per modulation. Long
// captures are subsampled evenly.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

// Effective SNR: SNR of a flat channel that has the mean bit error rate of a frequency-selective one.
//   ESNR = BER^-1( mean over subcarriers of BER(SNR_k) )
//   BER(rho): BPSK Q(sqrt(2 rho));  QPSK Q(sqrt(rho));
//             16-QAM 3/4 Q(sqrt(rho / 5));  64-QAM 7/12 Q(sqrt(rho / 21))
// Source: Halperin et al. 2010, "Predictable 802.11 packet delivery from wireless channel measurements".
// Error rates are handled as logarithms: at 80 dB they are exp(-1e8). The more bits per symbol, the smaller
// the effect of one weak subcarrier: min SNR <= ESNR of BPSK <= QPSK <= 16-QAM <= 64-QAM <= mean SNR
// (linear), like certainty equivalents of utilities with decreasing risk aversion a / 2 + 1 / (2 rho) (Pratt
// 1964). SNRs are in dB; -infinity is allowed and means a subcarrier without signal.

enum class Modulation { kBpsk, kQpsk, kQam16, kQam64 };

/// log BER(snr), accurate for any SNR, also where the rate itself underflows a double.
double log_bit_error_rate(double snr_db, Modulation modulation);

/// Takes at least one SNR, none NaN or +infinity; returns -infinity where no subcarrier has a signal. Cost:
/// one error function per subcarrier and 60 more.
double effective_snr_db(std::span<const double> snr_db, Modulation modulation);

// Received power and per-subcarrier SNR of an Intel 5300 CSI packet, as documented by the Linux 802.11n CSI
// Tool.
//   received power (dBm) = 10 log10(sum over used antennas of 10^(RSSI / 10)) - 44 - gain control
// The channel is reported on an arbitrary scale; its mean power over the subcarriers is set to the received
// power,
//   c = P_mW / mean_k |h_k|^2,     noise = thermal + quantisation,     H = sqrt(c / noise) h,
// with the measured thermal noise (-92 dBm where it was not measured) and quantisation noise of c per antenna
// and stream. Senders split their power among the streams, so H is scaled up by sqrt(2) for two streams and
// by 4.5 dB for three (that card's value for a factor of three). |H|^2 is then the SNR. Source: Halperin et
// al. 2011.

/// Received power; nothing where no antenna was used.
std::optional<double> received_power_dbm(const CsiPacket& packet);

/// The packet's channel H, scaled so that |H|^2 is an SNR; nothing without received power or where the
/// channel is zero.
std::optional<Eigen::MatrixXcd> channel_in_snr_units(const CsiPacket& packet);

/// SNR in dB per subcarrier and stream of a linear MMSE receiver (maximum ratio combining for a single
/// stream), ordered by subcarrier, then stream. Nothing in the same cases.
std::optional<std::vector<double>> subcarrier_snr_db(const CsiPacket& packet);

struct CapturePower {
  std::size_t packets = 0;                                       ///< all packets of the sender
  std::optional<double> received_power_dbm;                      ///< absent where the card does not report it
  std::vector<std::pair<std::string, double>> effective_snr_db;  ///< by modulation; empty without noise
};

/// Power of the packets from `sender`, or of all packets where absent.
CapturePower capture_power(const CsiCapture& capture, std::optional<MacAddress> sender);

}  // namespace radioslam
