// The only place that includes Boost.Asio. The order matters: version 1.74 uses std::exchange without including
// <utility>, which C++20 compilers report.
#pragma once

// clang-format off
#include <utility>
#include <boost/asio/buffer.hpp>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/write.hpp>
// clang-format on

namespace axisgate {

// All work for one line runs on one strand, so it needs no locks.
using Strand = boost::asio::strand<boost::asio::io_context::executor_type>;

}  // namespace axisgate
