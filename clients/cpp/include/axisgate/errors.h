// Errors of the package. An Error comes from the daemon, or from the connection to it.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "axisgate/export.h"

namespace axisgate {

// An argument is wrong. Nothing was sent.
class AXISGATE_PUBLIC InvalidArgument : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// A stop_token ended the call. The motion of a call that waits for its outcome is cancelled.
class AXISGATE_PUBLIC Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Parts of an Error.
struct ErrorParts {
  std::string reason;
  std::string message;
  std::string hint = {};
  std::optional<int> axis = std::nullopt;
  std::string sent = {};
  std::string wire_reply = {};
  std::string code = {};
};

// Base of all errors that the daemon reports, or that the connection to it causes. what() is the reason, the message,
// and the hint in parentheses.
class AXISGATE_PUBLIC Error : public std::runtime_error {
 public:
  explicit Error(ErrorParts parts);

  // Stable name of the reason: "OUTSIDE_TRAVEL". Programs should compare it, never the message. A reason that this
  // version does not know is "REASON 99".
  const std::string& reason() const noexcept { return parts_.reason; }
  // One sentence for people.
  const std::string& message() const noexcept { return parts_.message; }
  // Advice. May be empty.
  const std::string& hint() const noexcept { return parts_.hint; }
  // Number of the axis, from 1. nullopt: the error does not concern a single axis.
  std::optional<int> axis() const noexcept { return parts_.axis; }
  // Command line concerned. May be empty.
  const std::string& sent() const noexcept { return parts_.sent; }
  // The controller's reply. May be empty.
  const std::string& wire_reply() const noexcept { return parts_.wire_reply; }
  // Name of the gRPC code: "OUT_OF_RANGE". Empty: the error is not the answer to a call.
  const std::string& code() const noexcept { return parts_.code; }

 private:
  ErrorParts parts_;
};

// The request was refused: nothing moved.
class AXISGATE_PUBLIC Refused : public Error {
 public:
  using Error::Error;
};

// The target is outside the travel limits of the axis.
class AXISGATE_PUBLIC OutsideTravel : public Refused {
 public:
  using Refused::Refused;
};

// The axis must be homed before any other motion.
class AXISGATE_PUBLIC NotHomed : public Refused {
 public:
  using Refused::Refused;
};

// Another caller holds the axes, or moves them.
class AXISGATE_PUBLIC LeaseHeld : public Refused {
 public:
  using Refused::Refused;
};

// The lease of this program has ended.
class AXISGATE_PUBLIC LeaseLost : public Refused {
 public:
  using Refused::Refused;
};

// Another caller stopped the axes. Call Stage::rearm() before the next motion.
class AXISGATE_PUBLIC StoppedBy : public Refused {
 public:
  using Refused::Refused;
};

// The daemon does not know the caller, or the caller's role does not allow the request.
class AXISGATE_PUBLIC NotAllowed : public Refused {
 public:
  using Refused::Refused;
};

// The daemon or the controller cannot be reached.
class AXISGATE_PUBLIC Unavailable : public Refused {
 public:
  using Refused::Refused;
};

// A stop ended the motion, or prevented it.
class AXISGATE_PUBLIC Stopped : public Error {
 public:
  using Error::Error;
};

// The motion ended with an error.
class AXISGATE_PUBLIC MotionFailed : public Error {
 public:
  using Error::Error;
};

// The outcome is unknown. The axes may be moving: look at the stage before you repeat the request.
class AXISGATE_PUBLIC OutcomeUnknown : public Error {
 public:
  using Error::Error;
};

}  // namespace axisgate
