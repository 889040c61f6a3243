// The program's subcommands: each function registers one subcommand with its options and its action.
#pragma once

#include <CLI/App.hpp>

namespace radioslam::cli {

void add_anchors(CLI::App& program);
void add_aoa(CLI::App& program);
void add_simulate(CLI::App& program);
void add_run(CLI::App& program);
void add_prune(CLI::App& program);
void add_doctor(CLI::App& program);
void add_log(CLI::App& program);
void add_map(CLI::App& program);
void add_poses(CLI::App& program);
void add_evaluate(CLI::App& program);
void add_optimize(CLI::App& program);
void add_similarity(CLI::App& program);
void add_team(CLI::App& program);
void add_agent(CLI::App& program);
void add_import(CLI::App& program);
void add_rendezvous(CLI::App& program);
void add_reproduce(CLI::App& program);
void add_parameters(CLI::App& program);

}  // namespace radioslam::cli
