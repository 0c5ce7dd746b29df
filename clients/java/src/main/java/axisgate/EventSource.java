package axisgate;

import axisgate.v1.EventServiceGrpc;
import axisgate.v1.WatchResponse;
import java.util.Optional;

/** Source of the events after a cursor. */
record EventSource(DaemonChannel channel, Cursor cursor)
    implements Source<WatchResponse, EventOrGap> {
  @Override
  public Call<?, WatchResponse> begin() {
    return channel.beginWith(EventServiceGrpc.getWatchMethod(), cursor.request());
  }

  @Override
  public EventOrGap item(WatchResponse answer) {
    cursor.take(answer.getEvent());
    return Event.of(answer.getEvent());
  }

  @Override
  public Optional<EventOrGap> skip(Failure failure) {
    return cursor.gapAfter(failure).map(gap -> gap);
  }
}
