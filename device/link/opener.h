// Opens the line of a Runner in the background: opening takes time, and no strand waits for it.
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

// An attempt in progress. Releasing it abandons the attempt: no callback runs, and a line that still opens is closed.
using Opening = std::shared_ptr<void>;

// Begins to open a line, and never blocks. The answer comes once, on the strand, after this call has returned. Call it,
// and release the returned attempt, on the strand or while no thread runs its io_context.
using Opener = std::function<Opening(const Strand&, OnOpened)>;

// `open` must not block; it is called on the strand.
Opener opener_on_strand(std::function<OpenedLine()> open);

// `open` may block: each attempt calls it on its own thread.
Opener opener_on_thread(std::function<OpenedLine()> open);

}  // namespace axisgate
