// Confirmation of stops: axes stationary on a link that is up, and their prebuffers empty.
#pragma once

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/open_stops.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class StopLook {
 public:
  StopLook(Dialogue& dialogue, Reader& reader, StateStore& store, OpenStops& open, const Registers& registers,
           const NonHost& non_host, const Tasks& tasks)
      : dialogue_(dialogue),
        reader_(reader),
        store_(store),
        open_(open),
        registers_(registers),
        non_host_(non_host),
        tasks_(tasks) {}

  // Reads once, and confirms the stop if the reading shows that it was obeyed.
  Task<void> look(StopJobPtr job);

 private:
  enum class Prebuffers { empty, kept, unknown };

  bool counts(const StopJob& job) const;
  Task<bool> read(StopJobPtr job);
  bool is_certain(const StopJob& job) const;
  Task<bool> program_runs(const StopJob& job);
  Task<Prebuffers> read_prebuffers(StopJobPtr job);
  void note_kept(StopJob& job, const ExchangeResult& answer, std::string_view question);
  void confirm(const StopJobPtr& job);

  Dialogue& dialogue_;
  Reader& reader_;
  StateStore& store_;
  OpenStops& open_;
  const Registers& registers_;
  const NonHost& non_host_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
