package axisgate

import (
	"context"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// A Scan is a run of one axis at constant speed, with trigger pulses at equal intervals.
type Scan struct {
	// Axis is the name or number of the axis.
	Axis string
	// Start and End are the ends of the range. One pulse falls on Start.
	Start, End Distance
	// Every is the interval of the pulses.
	Every Distance
	// Speed is the speed in the range. Zero: the present speed of the axis.
	Speed Speed
}

// Scan starts a scan. [Result.Scan] has the expected and the observed number of pulses.
func (s *Stage) Scan(ctx context.Context, scan Scan) (*Motion, error) {
	request, err := scan.request(s.session.device)
	if err != nil {
		return nil, err
	}
	return start(ctx, s.session, s.session.stages.Scan, request)
}

func (s Scan) request(device string) (*axisgatev1.ScanRequest, error) {
	request := &axisgatev1.ScanRequest{Device: device, Axis: s.Axis}
	every := &axisgatev1.ScanRequest_Distance{}
	request.Interval = every
	var err error
	if request.Start, err = s.Start.message(); err != nil {
		return nil, err
	}
	if request.End, err = s.End.message(); err != nil {
		return nil, err
	}
	if every.Distance, err = s.Every.message(); err != nil {
		return nil, err
	}
	request.Speed, err = s.Speed.optional()
	return request, err
}
