//! A client of tonic alone, which sends the messages that the crate sends.

use std::time::{Duration, SystemTime};

use http::uri::PathAndQuery;
use tonic::client::Grpc;
use tonic::transport::{Channel, Endpoint};
use tonic::Request;
use tonic_prost::ProstCodec;

use crate::AnyError;
use v1::distance::Amount;

#[allow(clippy::all, clippy::pedantic, dead_code)]
mod v1 {
    include!(concat!(env!("OUT_DIR"), "/axisgate.v1.rs"));
}

const DEVICE: &str = "devices/stage";
const LIMIT: Duration = Duration::from_secs(10);

/// A Call is a request, which belongs to one call of the API.
trait Call: prost::Message + 'static {
    type Answer: prost::Message + Default + 'static;
    const PATH: &'static str;
}

/// A Bare client has one connection.
pub struct Bare(Channel);

impl Bare {
    pub async fn connect(target: &str) -> Result<Bare, AnyError> {
        let uri = if target.starts_with("unix:") { target.to_string() } else { format!("http://{target}") };
        Ok(Bare(Endpoint::from_shared(uri)?.connect().await?))
    }

    async fn call<Q: Call>(&self, request: Q) -> Result<Q::Answer, AnyError> {
        let mut request = Request::new(request);
        request.set_timeout(LIMIT);
        let mut grpc = Grpc::new(self.0.clone());
        grpc.ready().await?;
        let codec = ProstCodec::<Q, Q::Answer>::default();
        Ok(grpc.unary(request, PathAndQuery::from_static(Q::PATH), codec).await?.into_inner())
    }

    pub async fn get_device(&self) -> Result<(), AnyError> {
        let answer = self.call(v1::GetDeviceRequest { device: DEVICE.to_string(), max_age: None }).await?;
        answer.device.map(drop).ok_or_else(|| "no device".into())
    }

    /// Moves the axis x by some pulses, and waits for the outcome. `request_id` must be new.
    pub async fn move_by(&self, pulses: i64, request_id: String) -> Result<(), AnyError> {
        let listed = self.call(v1::ListDevicesRequest {}).await?;
        let context = v1::CallContext {
            request_id,
            request_memory: listed.request_memory,
            not_after: Some((SystemTime::now() + LIMIT / 2).into()),
            ..Default::default()
        };
        let distance = Some(v1::Distance { amount: Some(Amount::Pulses(pulses)) });
        let target = v1::AxisTarget { axis: "x".to_string(), distance, ..Default::default() };
        let (context, device) = (Some(context), DEVICE.to_string());
        let request = v1::MoveRequest { context, device, targets: vec![target], relative: true, ..Default::default() };
        let motion = self.call(request).await?.motion.ok_or("no motion")?.name;
        let wait = v1::WaitMotionRequest { motion, max_wait: LIMIT.try_into().ok() };
        let ended = self.call(wait).await?.motion.ok_or("no motion")?;
        if ended.state() != v1::MotionState::Succeeded {
            return Err(format!("{} did not succeed", ended.name).into());
        }
        Ok(())
    }
}
