// The start of a transaction: waits for its turn, and reads the state that must be known before the first line.
#pragma once

#include "device/shrc203/motion/entry.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/session/lease_settings.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/transaction/transaction.h"

namespace axisgate::shrc203 {

class TransactionStart {
 public:
  TransactionStart(Dialogue& dialogue, Explainer& explainer, Entry& entry, LeaseSettings& settings, Restorer& restorer,
                   Reader& reader, const StateStore& store, Motions& motions)
      : dialogue_(dialogue),
        explainer_(explainer),
        entry_(entry),
        settings_(settings),
        restorer_(restorer),
        reader_(reader),
        store_(store),
        motions_(motions) {}

  // Begins the transaction. False: it was refused, and the caller has received its end. `transaction` must outlive the
  // task, as in all classes of this folder.
  Task<bool> begin(Transaction& transaction);

 private:
  void create_motion(Transaction& transaction);
  Task<Result<void>> take_turn(Transaction& transaction);
  Task<Result<void>> learn_speeds(Transaction& transaction);
  Task<Result<void>> ask_for_destination(Transaction& transaction);
  Result<void> check_envelope(Transaction& transaction);

  Dialogue& dialogue_;
  Explainer& explainer_;
  Entry& entry_;
  LeaseSettings& settings_;
  Restorer& restorer_;
  Reader& reader_;
  const StateStore& store_;
  Motions& motions_;
};

}  // namespace axisgate::shrc203
