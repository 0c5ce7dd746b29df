// Moves one axis, and says what happened.
#include <axisgate/axisgate.h>

#include <iostream>

using namespace axisgate::literals;

int main() {
  try {
    axisgate::Stage stage;
    stage.home_if_needed({"x"});
    const axisgate::MotionResult result = stage["x"].move_to(1.5_mm);
    std::cout << "moved: " << result << '\n';
  } catch (const axisgate::OutcomeUnknown& error) {
    std::cout << "look at the stage: " << error.message() << '\n';
    return 1;
  } catch (const axisgate::Error& error) {
    std::cout << error.what() << '\n';
    return 1;
  }
}
