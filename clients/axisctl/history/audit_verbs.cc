// audit verify, erase: verifies the journal, and erases a name from it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

// Deadline of calls that read the whole journal.
constexpr std::chrono::seconds kJournalLimit{600};

std::string hex(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text;
}

// Returns "EPOCH:NUMBER:HASH", one line to note down.
std::string head_text(const v1::JournalHead& head) {
  return fmt::format("{}:{}:{}", head.epoch(), head.number(), hex(head.hash()));
}

v1::JournalHead head_of(const std::string& text) {
  const Failure wrong =
      usage("'" + text + "' is no head of a journal", "give one as `axisctl audit verify` printed it");
  const auto first = text.find(':'), second = text.find(':', first + 1);
  if (second == std::string::npos) throw wrong;
  v1::JournalHead head;
  head.set_epoch(text.substr(0, first));
  std::int64_t number = 0;
  if (std::from_chars(text.data() + first + 1, text.data() + second, number).ptr != text.data() + second) throw wrong;
  head.set_number(number);
  for (std::size_t at = second + 1; at < text.size(); at += 2) {
    unsigned byte = 0;
    const char* const end = text.data() + std::min(at + 2, text.size());
    if (std::from_chars(text.data() + at, end, byte, 16).ptr != end) throw wrong;
    head.mutable_hash()->push_back(static_cast<char>(byte));
  }
  return head;
}

// Returns the text for damage outside the entries. `fault` is SQLite's message.
std::string damage_text(const std::string& fault) {
  return "the file is damaged elsewhere, mostly in an index, so that `axisctl history` may lack entries: " + fault +
         " (to make the indices again, end the daemon and type `sqlite3 journal.sqlite REINDEX` in its state "
         "directory)";
}

int audit_verify(const Session& session) {
  v1::VerifyJournalRequest request;
  if (!session.options.head.empty()) *request.mutable_noted() = head_of(session.options.head);
  const v1::VerifyJournalResponse verdict = session.connection.call(
      session.connection.history, &v1::HistoryService::Stub::VerifyJournal, request, kJournalLimit);
  if (session.options.json) {
    print_json(verdict);
  } else if (verdict.first_bad() == 0) {
    print_line(fmt::format("{} entries are as they were written", verdict.good()));
    if (!verdict.fault().empty()) print_line(damage_text(verdict.fault()));
    print_line("head " + head_text(verdict.head()));
  } else {
    print_line(fmt::format("entry {}: {}", verdict.first_bad(), verdict.fault()));
  }
  return verdict.first_bad() == 0 && verdict.fault().empty() ? kDone : kFailed;
}

int audit_erase(const Session& session) {
  const std::string& who = session.options.who;
  if (!session.options.yes)
    throw usage("nothing was erased: nothing could bring the name back", "to erase it, add --yes");
  v1::ErasePersonRequest request;
  request.set_caller(who);
  const v1::ErasePersonResponse erased = session.connection.call(
      session.connection.history, &v1::HistoryService::Stub::ErasePerson, request, kJournalLimit);
  if (session.options.json) {
    print_json(erased);
    return kDone;
  }
  print_line(fmt::format("{} is now \"{}\"; entries: {}", who, erased.erased_as(), erased.entries()));
  if (erased.requests() > 0) {
    print_line(fmt::format("remembered requests that have the name until they are forgotten: {}", erased.requests()));
  }
  print_line("other files may have the name: `axisctl help audit` lists them");
  return kDone;
}

void audit_verify_options(CLI::App& verb, Options& options) {
  verb.add_option("--head", options.head, "a head that was printed before: checks that nothing up to there was changed")
      ->type_name("HEAD");
}

void audit_erase_options(CLI::App& verb, Options& options) {
  verb.add_option("NAME", options.who, "as `history` shows it, e.g. 'unix anna'")->required()->type_name("");
  verb.add_flag("--yes", options.yes, "do it: nothing brings the name back");
}

constexpr Verb kAuditVerbs[] = {
    {.words = "audit",
     .heading = Heading::looking,
     .description = "for the journal of `history`: verify, erase",
     .help =
         R"(The entries of the journal form a chain of hashes. `audit verify` names the first that was changed, removed or added,
or says what else of the file is damaged.
Who can write the file could compute all hashes again. So note the head that it prints, and check it later.

For administrators: `audit erase 'unix anna' --yes` puts "erased N" in the place of a name, in every entry and in the
bytes of the file. The chain of hashes is unchanged. The name may also be in the log of the daemon, in recordings, in
requests that the daemon remembers for a day, and in other files: docs/sharing.md lists them.)",
     .examples = "axisctl audit verify"},
    {.words = "audit verify",
     .description = "check that the journal is as it was written, and print its head",
     .add_options = audit_verify_options,
     .run = audit_verify},
    {.words = "audit erase",
     .description = "for administrators: erase the name of a caller from the journal, for ever",
     .add_options = audit_erase_options,
     .run = audit_erase},
};

}  // namespace

std::span<const Verb> audit_verbs() { return kAuditVerbs; }

}  // namespace axisgate::axisctl
