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
#pragma once

#include <optional>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Received power; nothing where no antenna was used.
std::optional<double> received_power_dbm(const CsiPacket& packet);

/// The packet's channel H, scaled so that |H|^2 is an SNR; nothing without received power or where the
/// channel is zero.
std::optional<Eigen::MatrixXcd> channel_in_snr_units(const CsiPacket& packet);

/// SNR in dB per subcarrier and stream of a linear MMSE receiver (maximum ratio combining for a single
/// stream), ordered by subcarrier, then stream. Nothing in the same cases.
std::optional<std::vector<double>> subcarrier_snr_db(const CsiPacket& packet);

}  // namespace radioslam
