// A Machine is a mill that plays a job in virtual time, without any clock: the modes that an instruction sets, and the
// moves that it causes (guideline 3, 5-2, 5-3).
#pragma once

#include <cstdint>
#include <optional>

#include "device/jobs/origin.h"
#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/instruction.h"
#include "device/rml1/language/parser.h"
#include "device/rml1/machine/clip.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// A straight piece of the real path.
struct Move {
  jobs::Point from, to;                   // steps, in workpiece coordinates; never the same
  double speed = 0;                       // mm/s, as commanded, limited to the highest speeds of the axes
  bool lowered = false;                   // moved by a command that keeps the tool lowered
  bool turning = false;                   // the spindle turns
  std::uint64_t end = 0;                  // number of bytes of the job that must arrive before the move
  Operation operation = Operation::plot;  // operation of the command
  jobs::Place place;                      // place of the command's first byte
  jobs::Place begin;                      // place of the first byte of the command, or of this set of its coordinates

  bool below_surface() const { return from.z < 0 || to.z < 0; }
  bool lifts() const { return from.x == to.x && from.y == to.y && to.z > from.z; }
  // Includes moves along the surface with the tool lowered.
  bool cuts() const { return below_surface() || (lowered && from.z == 0 && to.z == 0); }
  double cutting_part() const;  // fraction of the length that cuts, 0 to 1
};

class MoveListener {
 public:
  virtual ~MoveListener() = default;
  virtual void moved(const Move& move) = 0;
  // Reports a straight commanded piece that clipping leaves out. Steps, in workpiece coordinates.
  virtual void left_out(const jobs::Point& /*from*/, const jobs::Point& /*to*/) {}
};

enum class Wait : std::uint8_t { spin_up, dwell, turn };  // turn: of an axis of rotation, while nothing else moves

class MachineListener : public MoveListener {
 public:
  // `end`: number of bytes of the job that must arrive before.
  virtual void waited(Wait what, double seconds, std::uint64_t end) = 0;
  // Reports a commanded straight path, before clipping; with `height_alone` it is only a height. Steps, in workpiece
  // coordinates.
  virtual void commanded(const jobs::Point& from, const jobs::Point& target, bool height_alone,
                         const Instruction& by) = 0;
  // Reports that a command lifted the tool by `steps`, or to that height above Z0.
  virtual void lifted(double steps, const Instruction& by) = 0;
};

class Machine : public ParserListener {
 public:
  Machine(const Profile& profile, std::optional<jobs::Origin> origin, Diagnostics& diagnostics,
          MachineListener& listener);

  void execute(const Instruction& instruction) override;
  void quit() override;

  const jobs::Point& tool() const { return clipper_.tool(); }
  const jobs::Point& commanded() const { return commanded_; }
  const Box& box() const { return clipper_.box(); }
  bool tool_lowered() const { return lowered_; }
  bool relative() const { return relative_; }
  bool spindle_turns() const { return turning_; }
  bool spindle_permitted() const { return permitted_; }
  double z1() const { return z1_; }
  // Place of the first command that lowers the tool to a Z1 that the job has not set; nullopt if there is none.
  const std::optional<jobs::Place>& lowered_by_default() const { return lowered_by_default_; }
  double z2() const { return z2_.value_or(box().highest.z); }
  double cutting_speed() const { return cutting_speed_; }  // mm/s
  double z_speed() const { return z_speed_; }              // mm/s
  double dwell_s() const { return dwell_s_; }
  double rpm() const { return rpm_; }

 private:
  void perform(const Instruction& instruction);
  void plot(const Instruction& instruction);
  void take_tool(bool lowered, const Instruction& instruction);
  void feed(const Instruction& instruction);
  void extension(const Instruction& instruction);
  void turn(const AxisTarget& target, const Instruction& instruction);
  void home(const Instruction& instruction);
  void initialize(const Instruction& instruction);
  void set_defaults();
  void default_heights();
  void set_heights(const Instruction& instruction);
  void set_spindle(const Instruction& instruction);
  void set_height(const Instruction& instruction);
  void set_surface(const Instruction& instruction);
  void take_surface(double height, bool keeps_unsure);
  void pause(const Instruction& instruction);

  Box area() const;
  bool reachable(double height, const Instruction& instruction);
  double target(double value, double present) const { return relative_ ? present + value : value; }
  double aim(double& commanded, double value) const;
  void move_to(const jobs::Point& target, double speed, const Instruction& instruction, bool height_alone = false);
  void move_height(double z, const Instruction& instruction);
  void dwell(const Instruction& instruction);
  void start_spindle(const Instruction& instruction);
  Clipper::Driven driven(double speed, const Instruction& instruction);
  void drive(Piece piece, const jobs::Point& from, const jobs::Point& to, double speed, const Instruction& by);
  double possible(double speed, const jobs::Point& way) const;
  double height_of(double z) const { return z0_ + profile_.up * z; }                  // machine coordinate
  double above_surface(double height) const { return profile_.up * (height - z0_); }  // `height`: machine coordinate

  const Profile& profile_;
  const std::optional<jobs::Origin> origin_;
  Diagnostics& diagnostics_;
  MachineListener& listener_;

  const double travel_;   // travel of Z, in steps
  double z0_ = 0;         // machine coordinate, in steps, of the lowest place where Z0 may lie
  double z0_unsure_ = 0;  // number of steps by which Z0 may lie higher
  Clipper clipper_;
  jobs::Point commanded_;  // not rounded, because the sums of PR are not rounded either
  bool relative_ = false, lowered_ = false;
  double z1_ = 0;
  bool z1_set_ = false;
  std::optional<jobs::Place> lowered_by_default_;
  std::optional<double> z2_;  // nullopt: the top
  double cutting_speed_ = 0, z_speed_ = 0;
  double dwell_s_ = 0;
  bool permitted_ = true, turning_ = false;
  double rpm_ = 0;
  double angle_ = 0;  // degrees, of the axis of rotation
  bool other_axis_reported_ = false;
};

}  // namespace axisgate::rml1
