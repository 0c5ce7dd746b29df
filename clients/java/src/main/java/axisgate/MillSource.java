package axisgate;

import axisgate.v1.MillServiceGrpc;
import axisgate.v1.WatchMillRequest;
import axisgate.v1.WatchMillResponse;

/** Source of the states of a mill. */
record MillSource(DaemonChannel channel, String device)
    implements Source<WatchMillResponse, axisgate.v1.Mill> {
  @Override
  public Call<?, WatchMillResponse> begin() {
    var request = WatchMillRequest.newBuilder().setDevice(device).build();
    return channel.beginWith(MillServiceGrpc.getWatchMillMethod(), request);
  }

  @Override
  public axisgate.v1.Mill item(WatchMillResponse answer) {
    return answer.getMill();
  }
}
