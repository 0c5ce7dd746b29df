#include "server/journal/person_table.h"

#include <fmt/format.h>

namespace axisgate::server::journal {

std::string erased_name(std::int64_t number) { return fmt::format("erased {}", number); }

Result<std::int64_t> PersonTable::number_of(std::string_view name) {
  if (name.empty()) return 0;
  auto find = database_.prepare("SELECT id FROM person WHERE name = ?");
  if (!find) return tl::unexpected(find.error());
  const auto known = find->bind(1, name).step();
  if (!known || *known) return known.map([&](bool) { return find->integer(0); });
  auto insert = database_.prepare("INSERT INTO person(name) VALUES(?) RETURNING id");
  if (!insert) return tl::unexpected(insert.error());
  return insert->bind(1, name).step().map([&](bool) { return insert->integer(0); });
}

Result<std::optional<NamedPerson>> PersonTable::find(std::string_view name) {
  auto found = database_.prepare(
      "SELECT id, (SELECT count(*) FROM entry WHERE person = id), "
      "(SELECT count(*) FROM request WHERE identity = name OR instr(answer, name) > 0) "
      "FROM person WHERE name = ?");
  if (!found) return tl::unexpected(found.error());
  return found->bind(1, name).step().map([&](bool there) -> std::optional<NamedPerson> {
    if (!there || name == erased_name(found->integer(0))) return std::nullopt;
    return NamedPerson{found->integer(0), found->integer(1), found->integer(2)};
  });
}

// Rebuilds the table instead of changing the row, because SQLite leaves copies of a row in the pages between which it
// was moved. All pages of a dropped table are overwritten (secure_delete in Database::open).
Result<void> PersonTable::erase(std::int64_t number) {
  return database_.run(fmt::format("ALTER TABLE person RENAME TO person_before; {0}"
                                   "INSERT INTO person SELECT id, iif(id = {1}, '{2}', name) FROM person_before;"
                                   "DROP TABLE person_before;",
                                   kMake, number, erased_name(number))
                           .c_str());
}

}  // namespace axisgate::server::journal
