// Effective SNR: the SNR of a flat channel with the bit error rate that a faded one has on average.
//   ESNR = BER^-1( mean over subcarriers of BER(SNR_k) )
//   BER(rho): BPSK Q(sqrt(2 rho)); QPSK Q(sqrt(rho)); 16-QAM 3/4 Q(sqrt(rho / 5)); 64-QAM 7/12 Q(sqrt(rho /
//   21))
// Source: Halperin et al. 2010, "Predictable 802.11 packet delivery from wireless channel measurements".
// Error rates are handled as logarithms: at 80 dB they are exp(-1e8). The more bits a symbol holds, the less
// one bad subcarrier decides: least SNR <= ESNR of BPSK <= QPSK <= 16-QAM <= 64-QAM <= mean SNR (linear), as
// the certainty equivalents of utilities of falling risk aversion a / 2 + 1 / (2 rho) (Pratt 1964).
// SNRs in dB; -infinity, a subcarrier without any signal, is one.
#pragma once

#include <span>
#include <vector>

namespace radioslam {

enum class Modulation { kBpsk, kQpsk, kQam16, kQam64 };

/// log BER(snr): exact for any SNR, also where the rate itself is too small for a double.
double log_bit_error_rate(double snr_db, Modulation modulation);

/// One SNR at least, none NaN or +infinity. -infinity where there is no signal at all. Cost: 60 error
/// functions and one per subcarrier.
double effective_snr_db(std::span<const double> snr_db, Modulation modulation);

}  // namespace radioslam
