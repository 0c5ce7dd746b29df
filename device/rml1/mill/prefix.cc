#include "device/rml1/mill/prefix.h"

#include <algorithm>

namespace axisgate::rml1 {
namespace {

std::optional<double> parameter(const Instruction& instruction, std::size_t index = 0) {
  const bool given = instruction.count > index && instruction.given[index];
  return given ? std::optional(instruction.values[index]) : std::nullopt;
}

bool moves_z(const Instruction& instruction) {
  return std::ranges::any_of(instruction.axes, [](const AxisTarget& axis) { return axis.letter == 'Z'; });
}

}  // namespace

Prefix::Prefix(std::string_view job, std::uint64_t from, const Profile& profile, std::optional<jobs::Origin> origin)
    : from_(from),
      origin_known_(origin.has_value()),
      machine_(profile, origin, diagnostics_, *this),
      judge_(profile, diagnostics_) {
  Parser parser(profile.dialect, diagnostics_, *this);
  parser.feed(job);
  parser.finish();
}

void Prefix::execute(const Instruction& instruction) {
  if (next_) return;
  const jobs::Place begins = begin_of(instruction);
  if (begins.offset >= from_) {
    next_ = Next{begins, instruction.row->name, instruction.first};
    return;
  }
  has_effect_ = true;
  machine_.execute(instruction);
  judge_.executed(instruction);
  take_mode(instruction);
  take_height(instruction);
}

void Prefix::quit() {
  if (!next_) machine_.quit();
}

void Prefix::take_mode(const Instruction& instruction) {
  switch (instruction.row->operation) {
    case Operation::defaults:
    case Operation::initialize:
      modes_ = Modes{.revolutions = modes_.revolutions};
      return;
    case Operation::plane_speed:
      modes_.plane_speed = parameter(instruction);
      return;
    case Operation::height_speed:
      modes_.height_speed = parameter(instruction);
      return;
    case Operation::dwell:
      modes_.dwell_ms = parameter(instruction);
      return;
    case Operation::heights:
      if (instruction.count == 0) modes_.z1 = modes_.z2 = std::nullopt;
      if (const auto z1 = parameter(instruction, 0)) modes_.z1 = z1;
      if (const auto z2 = parameter(instruction, 1)) modes_.z2 = z2;
      return;
    case Operation::revolutions:
      if (const auto revolutions = parameter(instruction)) modes_.revolutions = revolutions;
      return;
    default:
      return;
  }
}

void Prefix::take_height(const Instruction& instruction) {
  switch (instruction.row->operation) {
    case Operation::plot:
      if (instruction.row->tool == Tool::kept && instruction.count == 0) return;
      height_ = machine_.tool_lowered() || modes_.z2 ? Height::workpiece : Height::top;
      return;
    case Operation::feed:
      if (!machine_.relative() && instruction.count > 0) height_ = Height::workpiece;
      break;
    case Operation::extension:
      if (!machine_.relative() && moves_z(instruction)) height_ = Height::workpiece;
      break;
    case Operation::home:
    case Operation::initialize:
      height_ = Height::top;
      return;
    case Operation::height:
      return take_machine_height(instruction);
    default:
      return;
  }
  const bool relative_z =
      instruction.row->operation == Operation::feed ? instruction.values[2] != 0 : moves_z(instruction);
  if (machine_.relative() && height_ != Height::workpiece && relative_z) {
    height_ = origin_known_ ? Height::workpiece : Height::unknown;
  }
}

void Prefix::take_machine_height(const Instruction& instruction) {
  if (instruction.count == 0) return;
  if (!machine_.relative()) {
    height_ = Height::machine;
    machine_height_ = instruction.values[0];
  } else {
    height_ = origin_known_ ? Height::workpiece : Height::unknown;
  }
}

}  // namespace axisgate::rml1
