package axisgate;

import axisgate.v1.DeviceServiceGrpc;
import axisgate.v1.WatchDeviceRequest;
import axisgate.v1.WatchDeviceResponse;
import java.time.Duration;

/** Source of the states of a stage. */
record StatusSource(DaemonChannel channel, String device, Duration interval)
    implements Source<WatchDeviceResponse, Status> {
  @Override
  public Call<?, WatchDeviceResponse> begin() {
    var request =
        WatchDeviceRequest.newBuilder()
            .setDevice(device)
            .setMinInterval(Times.message(interval))
            .build();
    return channel.beginWith(DeviceServiceGrpc.getWatchDeviceMethod(), request);
  }

  @Override
  public Status item(WatchDeviceResponse answer) {
    return Status.of(answer.getDevice());
  }
}
