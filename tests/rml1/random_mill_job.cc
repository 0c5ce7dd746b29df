#include "tests/rml1/random_mill_job.h"

#include <fmt/format.h>

#include "tests/simulation/random.h"

namespace axisgate::rml1 {
namespace {

using simulation::Random;

std::string pair(Random& random, std::int64_t least = 0, std::int64_t most = 1500) {
  const auto x = random.between(least, most), y = random.between(least, most);
  return fmt::format("{},{}", x, y);
}

// Returns a list of coordinates; a few are longer than the window of paced streaming.
std::string list(Random& random) {
  std::string list = "PD" + pair(random);
  for (auto more = random.between(0, 9); more > 0; --more) list += "," + pair(random);
  return list + ";";
}

// Returns moves that end before the next one has arrived over the line.
std::string raster(Random& random) {
  const auto y = random.between(0, 1500);
  std::string raster;
  for (std::int64_t x = 0, moves = random.between(5, 25); x < moves; ++x) raster += fmt::format("PD{},{}\n", x, y);
  return raster;
}

// Returns a command that moves nothing and takes no time.
std::string setting(Random& random) {
  switch (random.between(0, 4)) {
    case 0:
      return fmt::format("VS{};", random.between(2, 15));
    case 1:
      return fmt::format("V{};", random.between(2, 15));
    case 2:
      return fmt::format("W{};", random.between(0, 300));
    case 3:
      return fmt::format("!PZ-{},300;", random.between(50, 400));
    default:
      return fmt::format("!MC{};", random.between(0, 3));
  }
}

std::string relative(Random& random) {
  const std::string down = pair(random, -90, 90), up = pair(random, -90, 90);
  return fmt::format("^PR;PD{};PU{};^PA;", down, up);
}

std::string command(Random& random) {
  switch (random.between(0, 9)) {
    case 0:
    case 1:
      return fmt::format("PU{};", pair(random));
    case 2:
      return list(random);
    case 3: {
      const std::string flat = pair(random);
      return fmt::format("Z{},{}\n", flat, random.between(-500, 200));
    }
    case 4:
      return raster(random);
    case 5: {
      std::string settings;
      for (auto count = random.between(1, 60); count > 0; --count) settings += setting(random);
      return settings;
    }
    case 6:
      return relative(random);
    case 7:
      return fmt::format("!ZM-{};", random.between(0, 5500));
    case 8:
      return random.chance(0.5) ? "PD;" : "PU;";
    default:
      return fmt::format("PD{};", pair(random));
  }
}

}  // namespace

std::string random_mill_job(std::uint64_t seed, std::size_t bytes) {
  Random random(seed);
  std::string job = "^PA;!PZ-100,300;VS10;V10;";
  while (job.size() < bytes) job += command(random);
  return job;
}

}  // namespace axisgate::rml1
