// Study as one self-contained HTML page: data, style, script and d3 in one file, like the report.
#pragma once

#include <string>
#include <vector>

#include "radioslam/study/aoa/aoa_table.hpp"
#include "radioslam/study/distributed_optimization/distributed_study.hpp"
#include "radioslam/study/overlap_growth/overlap_growth.hpp"
#include "radioslam/study/rendezvous/rendezvous_study.hpp"
#include "radioslam/study/robustness_map/robustness_map.hpp"
#include "radioslam/study/study_table.hpp"
#include "radioslam/study/team/team_study.hpp"
#include "radioslam/study/verification_budget/budget_study.hpp"
#include "radioslam/study/wi_closure/place_study.hpp"

namespace radioslam {

/// `further`: tables below the first, each with its title, lead and notes.
std::string render_table_page(const StudyTable& table, const std::vector<StudyTable>& further = {});

/// The same with the trajectories of every way of running, of the first settings, above the table.
std::string render_places_page(const StudyTable& table, const std::vector<StudyTable>& further,
                               const PlaceStudy& drawn);

/// Heat maps of error, recall and failures, a column per number of false paths, with the table below.
std::string render_robustness_page(const RobustnessMap& map);

/// Seconds over poses and pairs kept, both axes logarithmic, with the table below.
std::string render_growth_page(const OverlapGrowth& growth);

/// Error over the registrations of each order, a chart per scenario, with the table below.
std::string render_budget_page(const std::vector<BudgetMission>& missions);

/// Bytes and errors over losses, partitions and team size, with the table below.
std::string render_team_page(const TeamStudy& study);

/// Gap to the central optimum over rounds and over bytes, two charts per team, with the table below.
std::string render_distributed_page(const std::vector<DistributedTeam>& teams);

/// Error over time, true errors and outliers as charts, runs on a map with a slider, and the table below.
std::string render_rendezvous_page(const RendezvousStudy& study);

/// A polar profile per link, with the true and the authors' direction, and the table below.
std::string render_aoa_page(const StudyTable& table, const std::vector<AoaLink>& links);

}  // namespace radioslam
