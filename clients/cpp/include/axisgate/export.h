// Visibility of the public names. Everything else in the shared library is hidden.
#pragma once

#define AXISGATE_PUBLIC __attribute__((visibility("default")))
