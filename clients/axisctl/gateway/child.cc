#include "clients/axisctl/gateway/child.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "clients/axisctl/failure.h"

namespace axisgate::axisctl {
namespace {

constexpr int kSignalled = 128;

volatile std::sig_atomic_t child_to_end = 0;

void pass_on(int signal) {
  if (child_to_end > 0) ::kill(static_cast<pid_t>(child_to_end), signal);
}

pid_t spawn(const std::vector<std::string>& command, const sigset_t& mask) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  // The command gets the default handling of the signals that axisctl ignores while it waits.
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t defaults;
  ::sigemptyset(&defaults);
  ::sigaddset(&defaults, SIGINT);
  ::sigaddset(&defaults, SIGQUIT);
  ::posix_spawnattr_setsigdefault(&attributes, &defaults);
  ::posix_spawnattr_setsigmask(&attributes, &mask);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, words[0], nullptr, &attributes, words.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  if (error != 0) throw usage(fmt::format("cannot run {}: {}", command.front(), std::strerror(error)), "");
  return child;
}

}  // namespace

int run_child(const std::vector<std::string>& command, const std::string& name, const std::string& value) {
  ::setenv(name.c_str(), value.c_str(), 1);
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGQUIT, SIG_IGN);
  // A signal that arrives while the command is being started is passed on to the command afterwards.
  sigset_t passed_on, before;
  ::sigemptyset(&passed_on);
  ::sigaddset(&passed_on, SIGTERM);
  ::sigaddset(&passed_on, SIGHUP);
  ::pthread_sigmask(SIG_BLOCK, &passed_on, &before);
  std::signal(SIGTERM, pass_on);
  std::signal(SIGHUP, pass_on);
  child_to_end = static_cast<std::sig_atomic_t>(spawn(command, before));
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  const auto child = static_cast<pid_t>(child_to_end);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  child_to_end = 0;
  return WIFSIGNALED(status) ? kSignalled + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace axisgate::axisctl
