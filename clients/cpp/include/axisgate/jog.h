// Axes that run until the end of a jog.
#pragma once

#include <memory>

#include "axisgate/motion.h"

namespace axisgate {

namespace client {
class JogRunner;
}

// A Jog runs axes until stop(), or until its destruction, which stops them, too. A thread keeps the axes running; the
// daemon stops them if the program does not run for 500 ms.
class AXISGATE_PUBLIC Jog {
 public:
  explicit Jog(std::unique_ptr<client::JogRunner> runner);
  ~Jog();
  Jog(Jog&&) noexcept;
  Jog& operator=(Jog&&) = delete;

  Motion motion() const;

  // Ends the jog: the axes slow down. Waits for the outcome. Throws Stopped, MotionFailed or OutcomeUnknown if
  // something else has ended the jog.
  MotionResult stop();

 private:
  std::unique_ptr<client::JogRunner> runner_;
};

}  // namespace axisgate
