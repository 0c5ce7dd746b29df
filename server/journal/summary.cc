#include "server/journal/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "server/journal/conditions.h"
#include "server/journal/entry.h"
#include "server/journal/store.h"

namespace axisgate::server::journal {
namespace {

using Json = nlohmann::json;

std::string fact(std::string_view name) { return fmt::format("json_extract({}, '$.{}')", kJsonBody, name); }

std::string is(EntryKind kind) { return fmt::format("kind = {}", static_cast<int>(kind)); }

std::string fact_of(EntryKind kind, std::string_view name) {
  return fmt::format("iif({}, {}, NULL)", is(kind), fact(name));
}

// The index of line changes (store.cc) is used only for statements with exactly this condition.
std::string of_line() { return is(EntryKind::link_changed) + " AND device = ? "; }

struct LinkEntry {
  std::int64_t number = 0;
  WallTime time;
  std::string device, link;
};

struct DaemonEntry {
  std::int64_t number = 0;
  WallTime time;
  bool started = false;
};

struct Person {
  WallTime first{}, last{};
  std::int64_t refused = 0;
  std::map<std::pair<std::string, std::string>, std::int64_t> motions{};  // numbers by kind and outcome
};

// Collects data in one pass over the entries of a span.
class Pass {
 public:
  Result<void> run(Database& database, const Span& span);

  std::map<std::int64_t, Person> persons;  // persons by their numbers
  Listed<StopSummary> stops;
  Listed<LateStop> late_stops;
  Listed<ConditionSummary> conditions;
  std::vector<LinkEntry> links;
  std::vector<DaemonEntry> daemon;

 private:
  enum Column : int {
    number,
    time,
    kind,
    device,
    person,
    motion_kind,
    outcome,
    refused,
    refusals,
    emergency,
    link,
    who,
    late,
    after_ms,
    condition
  };

  static std::string sql();
  void take(const Statement& row);
  void add_condition(const Statement& row);
  void count(EntryKind kind, const Statement& row);
};

// Skips lines, leases and latches. The query reads names for stops alone and bodies for conditions alone, because both
// are few.
std::string Pass::sql() {
  return fmt::format(
      "SELECT number, time_us, kind, device, person, {}, {}, {}, {}, {}, {}, "
      "iif({} OR {}, (SELECT name FROM person WHERE id = person), NULL), {}, {}, iif({}, body, NULL) FROM entry "
      "WHERE time_us >= ? AND time_us < ? AND kind < {} AND (? = '' OR device = ? OR {} OR {}) AND (? = '' OR {}) "
      "ORDER BY time_us",
      fact_of(EntryKind::motion_ended, "kind"),
      fmt::format("iif({} OR {}, {}, NULL)", is(EntryKind::motion_ended), is(EntryKind::stop_ended), fact("outcome")),
      fact_of(EntryKind::motion_ended, "refused"), fact_of(EntryKind::request_refused, "count"),
      fmt::format("iif({} OR {}, {}, NULL)", is(EntryKind::stop_requested), is(EntryKind::stop_ended),
                  fact("emergency")),
      fact_of(EntryKind::link_changed, "link"), is(EntryKind::stop_requested), is(EntryKind::stop_ended),
      fact_of(EntryKind::stop_ended, "late"), fact_of(EntryKind::stop_ended, "after_ms"),
      is(EntryKind::condition_changed), static_cast<int>(EntryKind::lines_exchanged), is(EntryKind::daemon_started),
      is(EntryKind::daemon_ended), kOfIdentity);
}

Result<void> Pass::run(Database& database, const Span& span) {
  auto rows = database.prepare(sql());
  if (!rows) return tl::unexpected(rows.error());
  rows->bind(1, span.from).bind(2, span.to).bind(3, span.device).bind(4, span.device);
  rows->bind(5, span.identity).bind(6, span.identity);
  while (true) {
    const auto there = rows->step();
    if (!there) return tl::unexpected(there.error());
    if (!*there) return {};
    take(*rows);
  }
}

void Pass::take(const Statement& row) {
  const auto what = static_cast<EntryKind>(row.integer(kind));
  if (row.integer(person) != 0 || what == EntryKind::motion_ended) count(what, row);
  switch (what) {
    case EntryKind::stop_requested:
      return stops.add(
          {row.time(time), std::string(row.bytes(who)), std::string(row.bytes(device)), row.integer(emergency) != 0});
    case EntryKind::stop_ended:
      if (row.integer(late) == 0) return;
      return late_stops.add({.time = row.time(time),
                             .who = std::string(row.bytes(who)),
                             .device = std::string(row.bytes(device)),
                             .emergency = row.integer(emergency) != 0,
                             .after = std::chrono::milliseconds(row.integer(after_ms)),
                             .confirmed = row.bytes(outcome) == "confirmed"});
    case EntryKind::condition_changed:
      return add_condition(row);
    case EntryKind::link_changed:
      return links.push_back(
          {row.integer(number), row.time(time), std::string(row.bytes(device)), std::string(row.bytes(link))});
    case EntryKind::daemon_started:
    case EntryKind::daemon_ended:
      return daemon.push_back({row.integer(number), row.time(time), what == EntryKind::daemon_started});
    default:
      return;
  }
}

void Pass::add_condition(const Statement& row) {
  const Json body = Json::parse(row.bytes(condition), nullptr, false);
  if (!body.is_object()) return;
  const auto time_of = [&](const char* key) {
    return WallTime(std::chrono::microseconds(body.value(key, std::int64_t{0})));
  };
  ConditionSummary summary{.seen = time_of("seen_us"),
                           .device = std::string(row.bytes(device)),
                           .condition = body.value("condition", ""),
                           .axes = body.value("axes", std::vector<int>()),
                           .begun = body.value("begun", false),
                           .value = body.value("value", "")};
  if (body.contains("before_us")) summary.before = time_of("before_us");
  conditions.add(std::move(summary));
}

void Pass::count(EntryKind what, const Statement& row) {
  Person& caller = persons.try_emplace(row.integer(person), Person{.first = row.time(time)}).first->second;
  caller.last = row.time(time);
  // An entry may count several requests.
  if (what == EntryKind::request_refused) caller.refused += std::max<std::int64_t>(row.integer(refusals), 1);
  // A motion that was refused before its first line has an entry for the refusal, too.
  if (what == EntryKind::motion_ended && row.integer(refused) == 0) {
    ++caller.motions[{std::string(row.bytes(motion_kind)), std::string(row.bytes(outcome))}];
  }
}

Result<Listed<PersonSummary>> named(Database& database, const std::map<std::int64_t, Person>& persons) {
  auto name = database.prepare("SELECT name FROM person WHERE id = ?");
  if (!name) return tl::unexpected(name.error());
  std::vector<PersonSummary> all;
  for (const auto& [number, person] : persons) {
    const auto there = name->bind(1, number).step();
    if (!there) return tl::unexpected(there.error());
    PersonSummary one{*there ? std::string(name->bytes(0)) : "", person.first, person.last, {}, person.refused};
    for (const auto& [what, count] : person.motions) one.motions.push_back({what.first, what.second, count});
    all.push_back(std::move(one));
    name->reset();
  }
  std::ranges::stable_sort(all, {}, &PersonSummary::first);
  Listed<PersonSummary> listed;
  for (PersonSummary& one : all) listed.add(std::move(one));
  return listed;
}

// Returns the devices that the daemon had at the beginning of the span, or had later. A line that was down when its
// device was removed from the configuration does not stay down forever.
Result<std::vector<std::string>> lines_of(Database& database, const Span& span) {
  auto lines = database.prepare(
      fmt::format("SELECT DISTINCT device FROM entry WHERE {} AND (? = '' OR device = ?) AND number > coalesce("
                  "(SELECT max(number) FROM entry WHERE device = '' AND motion = 0 AND {} AND time_us < ?), 0)",
                  is(EntryKind::link_changed), is(EntryKind::daemon_started)));
  if (!lines) return tl::unexpected(lines.error());
  lines->bind(1, span.device).bind(2, span.device).bind(3, span.from);
  std::vector<std::string> devices;
  while (true) {
    const auto there = lines->step();
    if (!there) return tl::unexpected(there.error());
    if (!*there) return devices;
    devices.emplace_back(lines->bytes(0));
  }
}

using DownSince = std::map<std::string, LinkEntry>;  // lines by device

// Returns the lines that were down when the span began. A failed attempt to connect reports DOWN again, but belongs to
// the same loss.
Result<DownSince> down_before(Database& database, const Span& span) {
  const auto devices = lines_of(database, span);
  if (!devices) return tl::unexpected(devices.error());
  auto first = database.prepare(fmt::format(
      "SELECT number, time_us FROM entry WHERE {0} AND time_us < ? AND {1} = 'DOWN' AND number > coalesce("
      "(SELECT number FROM entry WHERE {0} AND time_us < ? AND {1} = 'UP' ORDER BY number DESC LIMIT 1), 0) "
      "ORDER BY number LIMIT 1",
      of_line(), fact("link")));
  if (!first) return tl::unexpected(first.error());
  DownSince down;
  for (const std::string& device : *devices) {
    const auto there = first->bind(1, device).bind(2, span.from).bind(3, device).bind(4, span.from).step();
    if (!there) return tl::unexpected(there.error());
    if (*there) down.emplace(device, LinkEntry{first->integer(0), first->time(1), device, ""});
    first->reset();
  }
  return down;
}

Result<std::optional<WallTime>> up_after(Database& database, const LinkEntry& down) {
  auto up = database.prepare(
      fmt::format("SELECT time_us FROM entry WHERE {} AND number > ? AND {} = 'UP' ORDER BY number LIMIT 1", of_line(),
                  fact("link")));
  if (!up) return tl::unexpected(up.error());
  return up->bind(1, down.device).bind(2, down.number).step().map([&](bool there) {
    return there ? std::optional(up->time(0)) : std::nullopt;
  });
}

// Sorts by number, because setting the clock may have changed the order of the times.
Result<Listed<LinkLoss>> losses(Database& database, const Span& span, std::vector<LinkEntry> links) {
  auto down = down_before(database, span);
  if (!down) return tl::unexpected(down.error());
  std::ranges::sort(links, {}, &LinkEntry::number);
  std::vector<LinkLoss> all;
  for (LinkEntry& entry : links) {
    if (entry.link == "DOWN") down->try_emplace(entry.device, entry);
    if (entry.link != "UP") continue;
    if (const auto lost = down->extract(entry.device)) all.push_back({entry.device, lost.mapped().time, entry.time});
  }
  for (const auto& [device, since] : *down) {
    const auto up = up_after(database, since);
    if (!up) return tl::unexpected(up.error());
    all.push_back({device, since.time, *up});
  }
  std::ranges::stable_sort(all, {}, &LinkLoss::down);
  Listed<LinkLoss> listed;
  for (LinkLoss& one : all) listed.add(std::move(one));
  return listed;
}

// Reports whether a run began before this entry and has not ended.
Result<bool> runs_before(Database& database, const DaemonEntry& entry) {
  auto last = database.prepare(
      fmt::format("SELECT kind FROM entry WHERE device = '' AND motion = 0 AND ({} OR {}) AND number < ? "
                  "ORDER BY number DESC LIMIT 1",
                  is(EntryKind::daemon_started), is(EntryKind::daemon_ended)));
  if (!last) return tl::unexpected(last.error());
  return last->bind(1, entry.number).step().map([&](bool there) {
    return there && static_cast<EntryKind>(last->integer(0)) == EntryKind::daemon_started;
  });
}

Result<Listed<DaemonStart>> starts(Database& database, std::vector<DaemonEntry> entries) {
  Listed<DaemonStart> listed;
  if (entries.empty()) return listed;
  std::ranges::sort(entries, {}, &DaemonEntry::number);
  const auto before = runs_before(database, entries.front());
  if (!before) return tl::unexpected(before.error());
  bool runs = *before;
  for (const DaemonEntry& entry : entries) {
    if (entry.started) listed.add({entry.time, runs});
    runs = entry.started;
  }
  return listed;
}

}  // namespace

Result<Summary> summarize(Database& database, const Span& span) {
  Pass pass;
  if (const auto done = pass.run(database, span); !done) return tl::unexpected(done.error());
  auto persons = named(database, pass.persons);
  if (!persons) return tl::unexpected(persons.error());
  auto lost = losses(database, span, std::move(pass.links));
  if (!lost) return tl::unexpected(lost.error());
  auto started = starts(database, std::move(pass.daemon));
  if (!started) return tl::unexpected(started.error());
  return Summary{*std::move(persons),        std::move(pass.stops), std::move(pass.late_stops),
                 std::move(pass.conditions), *std::move(lost),      *std::move(started)};
}

}  // namespace axisgate::server::journal
