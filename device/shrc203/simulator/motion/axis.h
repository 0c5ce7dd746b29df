// One simulated axis: the stage and its sensors, the command counter, and what it is doing just now.
#pragma once

#include <cstdint>
#include <optional>

#include "device/core/time.h"
#include "device/shrc203/simulator/faults.h"
#include "device/shrc203/simulator/mileage.h"
#include "device/shrc203/simulator/motion/curve.h"
#include "device/shrc203/simulator/motion/motion_profile.h"
#include "device/shrc203/simulator/options.h"
#include "device/shrc203/simulator/units.h"

namespace axisgate::shrc203::simulator {

class Axis {
 public:
  // Stationary, moving, settling after the last pulse, or waiting (manual 57) WT:, 58) WI:).
  enum class Phase { idle, moving, settling, waiting };
  enum class LegEnd { next_leg, target, limit };

  static constexpr std::int64_t kDefaultDivide = 200;

  explicit Axis(const AxisSetup& setup);

  // Everything as at power-on, but the stage stays where it is.
  void power_on(TimePoint now);

  // --- the counter (pulses) -------------------------------------------------------------------------------------
  std::int64_t coordinate(TimePoint now) const { return place_at(now) - zero_; }
  std::int64_t zero() const { return zero_; }  // the place, from where it stood when it was built, that reads 0
  void preset(std::int64_t coordinate);        // manual 45) PSET:
  void set_logical_origin();                   // manual 63) R:
  void clear_logical_origin();                 // manual 64) RC:
  void set_mechanical_origin();

  // --- settings -------------------------------------------------------------------------------------------------
  Pitch pitch() const { return {base_nanometers_e6_, divide_}; }
  std::int64_t divide() const { return divide_; }
  void set_base(std::int64_t nanometers_e6) { base_nanometers_e6_ = nanometers_e6; }  // of an undivided pulse
  void set_divide(std::int64_t divide);  // the counter keeps its number of pulses

  Speed speed;         // manual 89) D:
  Speed origin_speed;  // manual 94) B:
  bool excited = true;
  bool open_loop = true;     // manual 51) F:
  bool emergency = false;    // bit 6 of the status
  bool limit_error = false;  // bit 8
  // These last as long as their cause, whatever is sent; but for an overflow error, which BEC: cancels (manual 53)).
  StatusBits errors;  // AxisError
  StatusBits flags;   // AxisFlag
  // As the memory switches had it at power-on (manual 5), 12), 32), 66)).
  char name = '1';
  char unit = 'U';
  bool configured = false;
  bool excited_in_emergency = false;
  bool error_stop() const { return emergency || errors.any(); }

  // --- sensors --------------------------------------------------------------------------------------------------
  bool limit_sensor(int direction, TimePoint now) const;
  bool any_limit_sensor(TimePoint now) const { return limit_sensor(1, now) || limit_sensor(-1, now); }
  bool origin_sensor(TimePoint now) const;
  void force_limit(int direction, bool on, TimePoint now);  // stops what moves into it

  // --- motion: each starts now, from an idle axis -----------------------------------------------------------------
  void move(std::int64_t amount, TimePoint now);
  void follow(std::int64_t amount, const MotionProfile& path, TimePoint now);  // its part of a straight line
  void follow(const Curve& curve, const MotionProfile& path, TimePoint now);   // its part of an arc
  void jog(int direction, TimePoint now);
  void return_to_origin(TimePoint now);
  void wait(std::optional<TimePoint> until);

  // Manual 93) JD:, while it jogs; pulses/s.
  void change_jog(std::int64_t to_speed, TimePoint now);

  void decelerate(TimePoint now);  // to S, then stationary; at once when no faster
  void halt(TimePoint now);        // no further pulse
  LegEnd end_leg(TimePoint now);   // at next_event() while moving; then settle(), rest() or another leg
  void settle(TimePoint until);
  void rest();

  Phase phase() const { return phase_; }
  Mileage mileage(TimePoint now) const;  // since start_mileage(), which is called when stationary
  void start_mileage() { mileage_ = {}; }
  bool stepped() const { return stepped_; }  // whether the last motion had any path to cover
  std::optional<TimePoint> next_event() const { return event_; }

 private:
  struct Leg {
    MotionProfile path;
    std::int64_t amount = 0;
    TimePoint start{};
    Speed slope;
    double begun = 0;  // how much of its first pulse the leg before it has made
    std::optional<Curve> curve;

    double pulses_per_unit() const;  // of the path
  };

  std::int64_t place_at(TimePoint now) const;
  void stand_at(std::int64_t place, TimePoint now);  // a leg ends there
  double fraction_at(TimePoint now) const;           // of the leg's path
  void watch_limits(TimePoint now);                  // of a leg along a curve
  std::int64_t in_pulses(std::int64_t setup_pulses) const;
  std::int64_t room(int direction) const;  // pulses left up to the limit sensor
  void start_leg(MotionProfile path, std::int64_t amount, const Speed& slope, TimePoint now);

  AxisSetup setup_;
  std::int64_t base_nanometers_e6_;
  std::int64_t divide_ = kDefaultDivide;
  std::int64_t place_ = 0;            // of the stage at the leg's start, from where it stood when it was built
  std::int64_t zero_ = 0;             // the place that reads 0
  std::int64_t mechanical_zero_ = 0;  // the same without R:
  Mileage mileage_;                   // up to the leg's start
  bool forced_plus_ = false, forced_minus_ = false;

  Phase phase_ = Phase::idle;
  Leg leg_;
  bool leg_meets_limit_ = false;
  std::int64_t curve_limit_ = 0;          // and where, seen from the start of a curve
  std::optional<std::int64_t> creep_to_;  // the last leg of an origin return
  bool stepped_ = false;
  std::optional<TimePoint> event_;
};

}  // namespace axisgate::shrc203::simulator
