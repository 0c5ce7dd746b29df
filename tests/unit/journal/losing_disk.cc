#include "tests/unit/journal/losing_disk.h"

#include <algorithm>
#include <utility>

namespace axisgate::disk_test {

void DiskFile::make(const Change& change, std::string& bytes) {
  if (!change.bytes) {
    bytes.resize(change.at);
    return;
  }
  bytes.resize(std::max(bytes.size(), change.at + change.bytes->size()));
  bytes.replace(change.at, change.bytes->size(), *change.bytes);
}

void DiskFile::write(std::size_t at, std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t part = std::min(bytes.size(), kSector - at % kSector);
    unsynced_.push_back({at, std::string(bytes.substr(0, part))});
    make(unsynced_.back(), now_);
    at += part;
    bytes.remove_prefix(part);
  }
}

void DiskFile::truncate(std::size_t size) {
  unsynced_.push_back({size});
  make(unsynced_.back(), now_);
}

void DiskFile::sync() {
  synced_ = now_;
  unsynced_.clear();
}

void DiskFile::cut_power(simulation::Random& random) {
  // Probability that an unsynced change survives, from 0 to 1.
  const double survival = static_cast<double>(random.between(0, 4)) / 4;
  for (std::size_t left = unsynced_.size(); left > 1; --left) {
    std::swap(unsynced_[left - 1], unsynced_[random.next() % left]);
  }
  for (const Change& change : unsynced_) {
    if (random.chance(survival)) make(change, synced_);
  }
  now_ = synced_;
  unsynced_.clear();
}

std::shared_ptr<DiskFile> LosingDisk::find(const std::string& name) const {
  const auto found = names_.find(name);
  return found == names_.end() ? nullptr : found->second.back();
}

std::shared_ptr<DiskFile> LosingDisk::create(const std::string& name) {
  auto& files = names_[name];
  if (files.empty()) files.push_back(nullptr);
  return files.emplace_back(std::make_shared<DiskFile>());
}

void LosingDisk::remove(const std::string& name) { names_.at(name).push_back(nullptr); }

void LosingDisk::sync(DiskFile& file) {
  at_sync([&] {
    if (file_syncs_ == FileSyncs::kept) file.sync();
  });
}

void LosingDisk::sync_directory() {
  at_sync([this] {
    for (auto& [name, files] : names_) files.erase(files.begin(), files.end() - 1);
  });
}

void LosingDisk::at_sync(const std::function<void()>& effect) {
  const bool cut = plan_ && --plan_->sync == 0;
  if (!cut || plan_->after) effect();
  if (cut) cut_power(plan_->seed);
}

void LosingDisk::cut_power(std::uint64_t seed) {
  power_ = false;
  simulation::Random random(seed);
  for (auto& [name, files] : names_) {
    files = {random.pick(files)};
    if (files.back()) files.back()->cut_power(random);
  }
}

void LosingDisk::restore_power() {
  plan_.reset();
  power_ = true;
}

}  // namespace axisgate::disk_test
