#include <fcntl.h>
#include <fmt/format.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "device/rml1/simulator/program/host_end.h"

namespace axisgate::rml1::simulator {
namespace {

class PtyEnd : public HostEnd {
 public:
  PtyEnd(const Strand& strand, Pty pty, Descriptor far_end)
      : pty_(std::move(pty)), far_end_(std::move(far_end)), stream_(strand, ::dup(pty_.master())) {}

  std::size_t read(std::span<char> bytes) override {
    const ssize_t size = ::read(pty_.master(), bytes.data(), bytes.size());
    return size > 0 ? static_cast<std::size_t>(size) : 0;
  }

  Stream& awaited() override { return stream_; }

  void write(std::string_view bytes) override {
    [[maybe_unused]] const ssize_t size = ::write(pty_.master(), bytes.data(), bytes.size());
  }

  // The settings are shared by both ends.
  bool stops_at_xoff() const override {
    termios settings{};
    return ::tcgetattr(far_end_.get(), &settings) == 0 && (settings.c_iflag & IXON) != 0;
  }

  bool may_change() const override { return true; }
  std::string name() const override { return fmt::format("{} ({})", pty_.link(), pty_.device()); }
  void close() override { stream_.close(); }

 private:
  Pty pty_;
  Descriptor far_end_;  // kept open, so that the terminal lives without a client
  Stream stream_;
};

}  // namespace

Result<std::unique_ptr<HostEnd>> open_pty_end(const Strand& strand, const std::string& link) {
  auto pty = open_pty(link);
  if (!pty) return tl::unexpected(pty.error());
  Descriptor far_end(::open(pty->device().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!far_end.valid()) {
    return fail(Reason::link_down,
                fmt::format("pseudo terminal {}: {}", pty->device(), std::generic_category().message(errno)));
  }
  return std::make_unique<PtyEnd>(strand, std::move(*pty), std::move(far_end));
}

}  // namespace axisgate::rml1::simulator
