// How a Runner gets its line: openings take their time, and no strand waits for them.
#pragma once

#include <functional>
#include <memory>

#include "device/core/problem.h"
#include "device/link/asio.h"
#include "device/link/descriptor.h"

namespace axisgate {

// An open, non-blocking descriptor, or the problem for people.
using OpenedLine = Result<Descriptor>;
using OnOpened = std::function<void(OpenedLine)>;

// An attempt under way. Releasing it abandons it: nobody is notified, and what still opens is closed.
using Opening = std::shared_ptr<void>;

// Begins to open a line, and never blocks. The answer comes once, on the strand, after this has returned. Call it, and
// let go of what it returns, on the strand or when no thread runs its io_context.
using Opener = std::function<Opening(const Strand&, OnOpened)>;

// `open` never blocks and is called on the strand.
Opener opener_on_strand(std::function<OpenedLine()> open);

// `open` may block: each attempt calls it on a thread of its own.
Opener opener_on_thread(std::function<OpenedLine()> open);

}  // namespace axisgate
