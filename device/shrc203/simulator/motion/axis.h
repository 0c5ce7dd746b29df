// One simulated axis: the stage and its sensors, the command counter, and the present motion.
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

  // Resets settings and counter to the power-on state; the stage stays where it is.
  void power_on(TimePoint now);

  // --- the counter (pulses) -------------------------------------------------------------------------------------
  std::int64_t coordinate(TimePoint now) const { return place_at(now) - zero_; }
  std::int64_t zero() const { return zero_; }  // position that reads 0, in pulses from the position at construction
  void preset(std::int64_t coordinate);        // manual 45) PSET:
  void set_logical_origin();                   // manual 63) R:
  void clear_logical_origin();                 // manual 64) RC:
  void set_mechanical_origin();

  // --- settings -------------------------------------------------------------------------------------------------
  Pitch pitch() const { return {base_nanometers_e6_, divide_}; }
  std::int64_t divide() const { return divide_; }
  void set_base(std::int64_t nanometers_e6) { base_nanometers_e6_ = nanometers_e6; }  // size of an undivided pulse
  void set_divide(std::int64_t divide);  // the counter keeps its number of pulses

  Speed speed;         // manual 89) D:
  Speed origin_speed;  // manual 94) B:
  bool excited = true;
  bool open_loop = true;     // manual 51) F:
  bool emergency = false;    // bit 6 of the status
  bool limit_error = false;  // bit 8
  // Errors and flags last until their cause ends, whatever is sent, except that BEC: cancels an overflow error (manual
  // 53)).
  StatusBits errors;  // AxisError
  StatusBits flags;   // AxisFlag
  // Values that the memory switches had at power-on (manual 5), 12), 32), 66)).
  char name = '1';
  char unit = 'U';
  bool configured = false;
  bool excited_in_emergency = false;
  bool error_stop() const { return emergency || errors.any(); }

  // --- sensors --------------------------------------------------------------------------------------------------
  bool limit_sensor(int direction, TimePoint now) const;
  bool any_limit_sensor(TimePoint now) const { return limit_sensor(1, now) || limit_sensor(-1, now); }
  bool origin_sensor(TimePoint now) const;
  void force_limit(int direction, bool on, TimePoint now);  // stops motion into the sensor

  // --- motion: each starts now, from an idle axis -----------------------------------------------------------------
  void move(std::int64_t amount, TimePoint now);
  void follow(std::int64_t amount, const MotionProfile& path, TimePoint now);  // this axis's part of a straight line
  void follow(const Curve& curve, const MotionProfile& path, TimePoint now);   // this axis's part of an arc
  void jog(int direction, TimePoint now);
  void return_to_origin(TimePoint now);
  void wait(std::optional<TimePoint> until);

  // Changes the speed of a running jog, in pulses/s (manual 93) JD:).
  void change_jog(std::int64_t to_speed, TimePoint now);

  void decelerate(TimePoint now);  // to S, then stationary; at once if no faster than S
  void halt(TimePoint now);        // at once, without a further pulse
  LegEnd end_leg(TimePoint now);   // call at next_event() while moving; then settle() or rest(), unless next_leg
  void settle(TimePoint until);
  void rest();

  Phase phase() const { return phase_; }
  Mileage mileage(TimePoint now) const;  // since start_mileage(), which must be called when stationary
  void start_mileage() { mileage_ = {}; }
  bool stepped() const { return stepped_; }  // the last motion had a distance to cover
  std::optional<TimePoint> next_event() const { return event_; }

 private:
  struct Leg {
    MotionProfile path;
    std::int64_t amount = 0;
    TimePoint start{};
    Speed slope;
    double begun = 0;  // part of the first pulse that the previous leg has already made
    std::optional<Curve> curve;

    double pulses_per_unit() const;  // per unit of the path's distance
  };

  std::int64_t place_at(TimePoint now) const;
  void stand_at(std::int64_t place, TimePoint now);  // ends a leg at this position
  double fraction_at(TimePoint now) const;           // covered part of the leg's path
  void watch_limits(TimePoint now);                  // for a leg along a curve: finds the sensor that it reaches first
  std::int64_t in_pulses(std::int64_t setup_pulses) const;
  std::int64_t room(int direction) const;  // pulses left before the limit sensor
  void start_leg(MotionProfile path, std::int64_t amount, const Speed& slope, TimePoint now);

  AxisSetup setup_;
  std::int64_t base_nanometers_e6_;
  std::int64_t divide_ = kDefaultDivide;
  std::int64_t place_ = 0;            // position at the leg's start, in pulses from the position at construction
  std::int64_t zero_ = 0;             // position that reads 0
  std::int64_t mechanical_zero_ = 0;  // position that reads 0 without R:
  Mileage mileage_;                   // up to the leg's start
  bool forced_plus_ = false, forced_minus_ = false;

  Phase phase_ = Phase::idle;
  Leg leg_;
  bool leg_meets_limit_ = false;
  std::int64_t curve_limit_ = 0;          // position of the limit sensor, from the start of a curve
  std::optional<std::int64_t> creep_to_;  // target of the last leg of an origin return
  bool stepped_ = false;
  std::optional<TimePoint> event_;
};

}  // namespace axisgate::shrc203::simulator
