// Speed of filling a journal with AXISGATE_ROWS entries (default: a million), and durations of reading a night and a
// page and of checking the chain. There is a move every three seconds, with four entries. Compare only figures of one
// run.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "server/journal/store.h"
#include "server/journal/summary.h"

namespace axisgate::server::journal {
namespace {

constexpr std::int64_t kEntriesAMove = 4, kGroup = 1000;
constexpr auto kBetweenMoves = std::chrono::seconds(3);
constexpr auto kNight = std::chrono::hours(12);

std::int64_t rows() {
  const char* given = std::getenv("AXISGATE_ROWS");
  return given == nullptr ? 1'000'000 : std::strtoll(given, nullptr, 10);
}

Entry entry(std::int64_t number) {
  const std::int64_t move = number / kEntriesAMove;
  const auto since = kBetweenMoves * move;
  Entry made{.kind = EntryKind::request_made,
             .time = WallTime(since),
             .boot_time = TimePoint(since),
             .device = "stage",
             .who = fmt::format("unix user-{}", move % 5)};
  made.motion = static_cast<std::uint64_t>(move + 1);
  switch (number % kEntriesAMove) {
    case 0:
      made.motion = 0;
      made.body = fmt::format(R"({{"request":"move","what":"1 by {} pulses","role":"operator","request_id":"{:036}"}})",
                              move, move);
      break;
    case 1:
      made.kind = EntryKind::motion_requested;
      made.body = fmt::format(R"({{"axes":[1],"kind":"move","request_id":"{:036}"}})", move);
      break;
    case 2:
      made.kind = EntryKind::motion_started;
      made.body = fmt::format(
          R"({{"axes":[1],"kind":"move","request_id":"{:036}","lines":[["MP:1+P20000","OK",2100],["G:1","OK",4200]]}})",
          move);
      break;
    default:
      made.kind = EntryKind::motion_ended;
      made.body = fmt::format(
          R"({{"axes":[1],"kind":"move","request_id":"{:036}","outcome":"SUCCEEDED","results":[{{"axis":1,"command_pulses":{},"target_pulses":{}}}]}})",
          move, move, move);
  }
  return made;
}

// Journal that is filled once and removed at the end.
class Filled {
 public:
  Filled() {
    Store store = *Store::open(path_);
    for (std::int64_t first = 0; first < rows(); first += kGroup) {
      std::vector<Record> group;
      for (std::int64_t number = first; number < first + kGroup; ++number) group.push_back({entry(number)});
      if (!store.append(group)) std::abort();
    }
  }
  ~Filled() { std::filesystem::remove_all(folder_); }
  Filled(const Filled&) = delete;
  Filled& operator=(const Filled&) = delete;

  std::uintmax_t bytes() const { return std::filesystem::file_size(path_); }
  const std::string& path() const { return path_; }

 private:
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("axisgate-journal-{}", std::random_device()());
  const std::string path_ = (std::filesystem::create_directory(folder_), folder_ / "journal.sqlite");
};

const Filled& filled() {
  static const Filled journal;
  return journal;
}

WallTime end_of_all() { return WallTime(kBetweenMoves * (rows() / kEntriesAMove)); }

void Append(benchmark::State& state) {
  Store store = *Store::open(filled().path());
  std::int64_t number = 0;
  for (auto _ : state) {
    const Record one{entry(number++)};
    if (!store.append({&one, 1})) state.SkipWithError("the disk refuses it");
  }
}

void Night(benchmark::State& state) {
  const std::string& path = filled().path();
  const WallTime to = end_of_all() - kNight;
  for (auto _ : state) {
    auto database = *Database::open(path, Database::Access::read);
    benchmark::DoNotOptimize(summarize(database, {.from = to - kNight, .to = to}));
  }
  state.counters["file MB"] = static_cast<double>(filled().bytes()) / 1e6;
}

// Reads the first hundred entries of one caller.
void Page(benchmark::State& state) {
  const std::string& path = filled().path();
  for (auto _ : state) {
    auto store = *Store::open_to_read(path);
    Filter filter;
    filter.who = "unix user-3";
    benchmark::DoNotOptimize(store.read(filter, 100));
  }
}

// Reads the entries of one motion, which are far back.
void OneMotion(benchmark::State& state) {
  const std::string& path = filled().path();
  for (auto _ : state) {
    auto store = *Store::open_to_read(path);
    Filter filter;
    filter.device = "stage";
    filter.motion = 1000;
    benchmark::DoNotOptimize(store.read(filter, 100));
  }
}

void Verify(benchmark::State& state) {
  const std::string& path = filled().path();
  for (auto _ : state) {
    auto store = *Store::open_to_read(path);
    const auto verdict = store.verify(std::nullopt);
    if (!verdict || verdict->first_bad) state.SkipWithError("the chain is broken");
  }
  state.SetItemsProcessed(state.iterations() * rows());
}

BENCHMARK(Night)->Unit(benchmark::kMillisecond);
BENCHMARK(Page)->Unit(benchmark::kMillisecond);
BENCHMARK(OneMotion)->Unit(benchmark::kMillisecond);
BENCHMARK(Verify)->Unit(benchmark::kSecond)->Iterations(1);
BENCHMARK(Append)->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace
}  // namespace axisgate::server::journal

BENCHMARK_MAIN();
