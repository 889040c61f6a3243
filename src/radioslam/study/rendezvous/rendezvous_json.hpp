// The study of rendezvous as JSON: charts and replays, for the page and for table.json.
#pragma once

#include <nlohmann/json.hpp>

#include "radioslam/study/rendezvous/rendezvous_study.hpp"

namespace radioslam {

/// {"charts": [...], "replays": [...]}, as study/page/rendezvous.js describes.
nlohmann::ordered_json rendezvous_page_json(const RendezvousStudy& study);

/// Every run of every figure, without moments.
nlohmann::ordered_json rendezvous_json(const RendezvousStudy& study);

}  // namespace radioslam
