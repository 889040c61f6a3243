// What outlives an agent, in a journal on the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "radioslam/io/journal/journal.hpp"
#include "radioslam/team/virtual_team.hpp"

namespace radioslam::cli {

class JournalStore : public AgentStore {
 public:
  JournalStore(const std::filesystem::path& file, const std::string& robot, std::uint32_t life_if_new)
      : journal_(file, robot, life_if_new), next_life_(life_if_new) {}

  AgentMemory memory() const override {
    return {journal_.life(), journal_.logs(), next_life_,
            [this](const std::string& key) { return state(key); }};
  }
  std::optional<std::string> state(const std::string& key) const override { return journal_.state(key); }
  void commit(const JournalChange& change) override { journal_.commit(change); }

 private:
  Journal journal_;
  std::uint32_t next_life_;
};

}  // namespace radioslam::cli
