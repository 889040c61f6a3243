// The parameters of `radioslam similarity`, with the names they have in a run.
#pragma once

#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity.hpp"

namespace radioslam::cli {

struct PairParams {
  FingerprintParams fingerprint;
  SimilarityParams similarity;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    FingerprintParams::visit_fields(self.fingerprint, visit);
    SimilarityParams::visit_fields(self.similarity, visit);
  }
};

struct SimilarityCommandParams {
  PairParams radio;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("radio", self.radio);
  }
};

}  // namespace radioslam::cli
