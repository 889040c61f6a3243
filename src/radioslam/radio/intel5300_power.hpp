// What an Intel 5300 packet says of power, as the Linux 802.11n CSI Tool documents its card.
//   received power (dBm) = 10 log10(sum over used antennas of 10^(RSSI / 10)) - 44 - gain control
// The channel comes in a scale of its own. Its mean power over the subcarriers stands for the received power,
//   c = P_mW / mean_k |h_k|^2,     noise = thermal + quantisation,     H = sqrt(c / noise) h,
// thermal noise as measured or -92 dBm where not, quantisation one unit of power per antenna and stream, c
// each. Senders split their power among the streams: H is made larger by sqrt(2) for two, and by the 4.5 dB
// that stand for a factor of three in that card. |H|^2 is then the SNR. Source: Halperin et al. 2011.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Nothing where no antenna was used.
std::optional<double> received_power_dbm(const CsiPacket& packet);

/// The packet's channel in units of the square root of an SNR; nothing without power or with a channel of
/// zeros.
std::optional<Eigen::MatrixXcd> channel_in_snr_units(const CsiPacket& packet);

/// The SNR in dB of every subcarrier and stream that a linear minimum mean square error receiver has
/// (maximum ratio combining of the antennas where there is one stream), the streams of one subcarrier
/// together. Nothing as above.
std::optional<std::vector<double>> subcarrier_snr_db(const CsiPacket& packet);

}  // namespace radioslam
