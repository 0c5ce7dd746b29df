//! The API's messages, and what they have in common.

pub use v1::*;

#[allow(clippy::all, clippy::pedantic, dead_code, missing_docs)]
mod v1 {
    include!(concat!(env!("OUT_DIR"), "/axisgate.v1.rs"));
}

/// A Call is a request, which belongs to one call of the API.
pub trait Call: prost::Message + Clone + Default + 'static {
    type Answer: prost::Message + Default + 'static;
    const PATH: &'static str;
}

/// A Changing request changes something, and has a context.
pub trait Changing: Call {
    fn set_context(&mut self, context: CallContext);
}

/// A Starting answer has the motion that was started.
pub trait Starting {
    fn motion(self) -> Option<Motion>;
}

macro_rules! changing {
    ($($request:ident),* $(,)?) => {$(
        impl Changing for $request {
            fn set_context(&mut self, context: CallContext) {
                self.context = Some(context);
            }
        }
    )*};
}

macro_rules! starting {
    ($($answer:ident),*) => {$(
        impl Starting for $answer {
            fn motion(self) -> Option<Motion> {
                self.motion
            }
        }
    )*};
}

changing!(
    AcquireLeaseRequest,
    CancelJobRequest,
    CancelMotionRequest,
    ChangeSettingsRequest,
    ClearErrorsRequest,
    ConfirmJobRequest,
    DeletePositionRequest,
    HandOverLeaseRequest,
    HomeRequest,
    MoveRequest,
    MoveToPositionRequest,
    OperateMillRequest,
    PauseJobRequest,
    RearmRequest,
    ReleaseLeaseRequest,
    ReportJobDoneRequest,
    ResumeJobRequest,
    SavePositionRequest,
    ScanRequest,
    StartJobRequest,
);
starting!(HomeResponse, MoveResponse, MoveToPositionResponse, ScanResponse);

/// Returns the name of an enum's value without its prefix, or the prefix with the number of an unknown value.
pub fn enum_name<E: TryFrom<i32>>(number: i32, prefix: &str, name: fn(&E) -> &'static str) -> String {
    match E::try_from(number) {
        Ok(value) => name(&value).trim_start_matches(prefix).to_string(),
        Err(_) => format!("{prefix}{number}"),
    }
}

/// Returns the duration as a message.
pub fn duration(duration: std::time::Duration) -> prost_types::Duration {
    prost_types::Duration::try_from(duration).unwrap_or(prost_types::Duration { seconds: i64::MAX, nanos: 0 })
}

/// Returns the time as the system's time. The epoch: no valid time.
pub fn system_time(time: Option<prost_types::Timestamp>) -> std::time::SystemTime {
    time.and_then(|time| time.try_into().ok()).unwrap_or(std::time::UNIX_EPOCH)
}
