#include "radioslam/io/text/atomic_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <mutex>
#include <system_error>
#include <vector>

#include "radioslam/base/input_error.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

constexpr int kRemovalAttempts = 10;  // another thread may still be adding files

/// An unfinished output and the parent folders that were created for it.
struct Unfinished {
  fs::path temporary;
  std::vector<fs::path> made_folders;
};

struct Registry {
  std::mutex mutex;
  std::vector<Unfinished> entries;
  bool closed = false;
  int count = 0;
};

Registry& registry() {
  static Registry the_registry;
  return the_registry;
}

void remove_tree(const fs::path& path) {
  std::error_code error;
  for (int attempt = 0; attempt < kRemovalAttempts; ++attempt) {
    fs::remove_all(path, error);
    if (!error) return;
  }
}

void remove(const Unfinished& entry) {
  remove_tree(entry.temporary);
  std::error_code ignored;
  for (const fs::path& folder : entry.made_folders) fs::remove(folder, ignored);  // only if empty
}

/// The path with symbolic links resolved and without a trailing slash.
fs::path resolved(const fs::path& target) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(target), error);
  if (error) throw InputError(target.string(), 0, "cannot be written: " + error.message());
  return path.has_filename() ? path : path.parent_path();
}

/// The parent folders of `path` that do not exist, deepest first.
std::vector<fs::path> missing_folders(const fs::path& path) {
  std::vector<fs::path> missing;
  for (fs::path folder = path.parent_path(); !fs::exists(folder); folder = folder.parent_path())
    missing.push_back(folder);
  return missing;
}

fs::path beside(const fs::path& target, int number) {
  const std::string name = "." + target.filename().string() + ".unfinished-" + std::to_string(::getpid()) +
                           "-" + std::to_string(number);
  return target.parent_path() / name;
}

void refuse_foreign_folder(const fs::path& target, const fs::path& resolved_target, std::string_view marker) {
  if (!fs::exists(resolved_target)) return;
  if (!fs::is_directory(resolved_target)) throw InputError(target.string(), 0, "is a file, not a folder");
  if (fs::is_empty(resolved_target) || fs::exists(resolved_target / marker)) return;
  throw InputError(target.string(), 0,
                   "this folder is not replaced: it is not empty, and has no " + std::string(marker) +
                       " that marks it as written by this command");
}

[[noreturn]] void fail(int error, const fs::path& path) {
  throw std::system_error(error, std::generic_category(), path.string());
}

void refuse_when_closed(const fs::path& path) {
  if (registry().closed) fail(ECANCELED, path);
}

/// Moves `from` to `to`; an existing folder at `to` ends up at `from`.
void exchange(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) fail(errno, to);
  const fs::path aside = from.string() + ".old";
  fs::rename(to, aside);
  fs::rename(from, to);
  fs::rename(aside, from);
}

void exchange_or_move(const OutputFolder::Move& move) {
  fs::create_directories(move.to.parent_path());
  if (fs::exists(move.to))
    exchange(move.from, move.to);
  else
    fs::rename(move.from, move.to);
}

void undo(const OutputFolder::Move& move) {
  std::error_code ignored;
  if (fs::exists(move.from, ignored))
    exchange(move.from, move.to);
  else
    fs::rename(move.to, move.from);
  fs::remove(move.to.parent_path(), ignored);  // only if empty
}

}  // namespace

UnfinishedOutput::UnfinishedOutput(const fs::path& target) : target_(resolved(target)) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  refuse_when_closed(target_);
  temporary_ = beside(target_, all.count++);
  all.entries.push_back({temporary_, missing_folders(target_)});
  std::error_code error;
  fs::create_directories(target_.parent_path(), error);
  if (!error) return;
  remove(all.entries.back());
  all.entries.pop_back();
  throw InputError(target.string(), 0, "cannot be written: " + error.message());
}

UnfinishedOutput::~UnfinishedOutput() {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto entry = std::find_if(all.entries.begin(), all.entries.end(),
                                  [this](const Unfinished& e) { return e.temporary == temporary_; });
  if (entry == all.entries.end()) return;
  remove(*entry);
  all.entries.erase(entry);
}

OutputFolder::OutputFolder(const fs::path& target, std::string_view marker) : UnfinishedOutput(target) {
  refuse_foreign_folder(target, target_, marker);
  std::error_code error;
  if (!fs::create_directory(temporary_, error))
    throw InputError(target.string(), 0, "cannot be written: " + error.message());
}

void OutputFolder::commit() {
  const std::lock_guard lock(registry().mutex);
  refuse_when_closed(target_);
  if (fs::exists(target_)) {
    exchange(temporary_, target_);
  } else {
    fs::rename(temporary_, target_);
  }
}

void OutputFolder::commit_parts(const std::vector<Move>& moves) {
  const std::lock_guard lock(registry().mutex);
  refuse_when_closed(target_);
  std::size_t done = 0;
  try {
    for (; done < moves.size(); ++done) exchange_or_move(moves[done]);
  } catch (const std::system_error&) {
    while (done-- > 0) undo(moves[done]);
    throw;
  }
}

OutputFile::OutputFile(const fs::path& target) : UnfinishedOutput(target) {
  if (fs::exists(target_) && !fs::is_regular_file(target_))
    throw InputError(target.string(), 0, "is not a file that can be replaced");
  if (::access(target_.parent_path().c_str(), W_OK) != 0)
    throw InputError(target.string(), 0, "cannot be written: " + std::generic_category().message(errno));
}

void OutputFile::append(std::string_view part) {
  if (!file_) {
    const std::lock_guard lock(registry().mutex);
    refuse_when_closed(target_);
    file_.reset(std::fopen(temporary_.c_str(), "wb"));
    if (!file_) fail(errno, temporary_);
  }
  if (std::fwrite(part.data(), 1, part.size(), file_.get()) != part.size()) fail(errno, temporary_);
}

void OutputFile::flush() {
  if (file_ && std::fflush(file_.get()) != 0) fail(errno, temporary_);
}

void OutputFile::commit(std::string_view content) {
  append(content);
  if (std::fclose(file_.release()) != 0) fail(errno, temporary_);
  const std::lock_guard lock(registry().mutex);
  refuse_when_closed(target_);
  fs::rename(temporary_, target_);
}

FileWriter::FileWriter(const fs::path& path) : path_(path), file_(nullptr, &std::fclose) {
  const std::lock_guard lock(registry().mutex);  // no file appears where all have been removed
  refuse_when_closed(path);
  fs::create_directories(path.parent_path());
  file_.reset(std::fopen(path.c_str(), "wb"));
  if (!file_) fail(errno, path);
}

void FileWriter::write(std::string_view part) {
  if (std::fwrite(part.data(), 1, part.size(), file_.get()) != part.size()) fail(errno, path_);
}

void FileWriter::close() {
  if (std::fclose(file_.release()) != 0) fail(errno, path_);
}

void write_file(const fs::path& path, std::string_view content) {
  FileWriter file(path);
  file.write(content);
  file.close();
}

void remove_unfinished_outputs() noexcept {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  all.closed = true;
  for (const Unfinished& entry : all.entries) remove(entry);
}

}  // namespace radioslam
