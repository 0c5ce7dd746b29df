package axisgate

import (
	"context"
	"iter"
	"time"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// segmentTime is the time for sending one segment, which is added to the limit of the request.
const segmentTime = time.Second / 2000

// A Point has one position for each axis, in the order of the axes.
type Point []Distance

// A Path is a series of points through which axes move without a halt.
type Path struct {
	// Axes are the names or numbers of the axes.
	Axes []string
	// Points are the points. All are read before the path starts, so nothing moves if one comes with an error.
	Points iter.Seq2[Point, error]
	// Speed is the speed along the path. Zero: the present speed profiles of the axes.
	Speed Speed
}

// Points returns the points of a series that has no errors: axisgate.Points(slices.Values(grid)).
func Points(points iter.Seq[Point]) iter.Seq2[Point, error] {
	return func(yield func(Point, error) bool) {
		for point := range points {
			if !yield(point, nil) {
				return
			}
		}
	}
}

// Path starts a path.
func (s *Stage) Path(ctx context.Context, path Path) (*Motion, error) {
	segments, err := path.segments()
	if err != nil {
		return nil, err
	}
	patience := time.Duration(len(segments)) * segmentTime
	motion, err := act(ctx, s.session.connection, s.session.token(ctx), patience,
		func(call *axisgatev1.CallContext) attempt[*axisgatev1.Motion] {
			header := &axisgatev1.PathHeader{Context: call, Device: s.session.device}
			return func(ctx context.Context) (*axisgatev1.Motion, error) {
				return s.session.runPath(ctx, header, segments)
			}
		})
	if err != nil {
		return nil, err
	}
	return newMotion(s.session, motion), nil
}

// Visit moves to one point of the path after another, and yields the result once the axes are stationary at each point.
// The end of ctx cancels the present move. Use Visit under a lease, so that nobody else moves the axes in between.
func (s *Stage) Visit(ctx context.Context, path Path) iter.Seq2[*Result, error] {
	return func(yield func(*Result, error) bool) {
		for point, err := range path.Points {
			var result *Result
			if err == nil {
				result, err = s.visit(ctx, path, point)
			}
			if !yield(result, err) || err != nil {
				return
			}
		}
	}
}

func (s *Stage) visit(ctx context.Context, path Path, point Point) (*Result, error) {
	if err := path.check(point); err != nil {
		return nil, err
	}
	targets := Targets{}
	for i, axis := range path.Axes {
		targets[axis] = point[i]
	}
	if path.Speed == (Speed{}) {
		return s.MoveTo(ctx, targets)
	}
	return s.MoveTo(ctx, targets, WithSpeed(path.Speed))
}

func (p Path) check(point Point) error {
	if len(p.Axes) == 0 || len(point) != len(p.Axes) {
		return invalid("a point has %d distances for %d axes", len(point), len(p.Axes))
	}
	return nil
}

func (p Path) segments() ([]*axisgatev1.Segment, error) {
	speed, err := p.Speed.optional()
	if err != nil {
		return nil, err
	}
	var segments []*axisgatev1.Segment
	for point, err := range p.Points {
		if err != nil {
			return nil, err
		}
		segment, err := p.segment(point, speed)
		if err != nil {
			return nil, err
		}
		segments = append(segments, segment)
	}
	return segments, nil
}

// segment returns the piece of the path that leads to a point.
func (p Path) segment(point Point, speed *axisgatev1.Speed) (*axisgatev1.Segment, error) {
	if err := p.check(point); err != nil {
		return nil, err
	}
	line := &axisgatev1.Line{}
	for i, axis := range p.Axes {
		distance, err := point[i].message()
		if err != nil {
			return nil, err
		}
		line.Distances = append(line.Distances, &axisgatev1.AxisDistance{Axis: axis, Distance: distance})
	}
	if len(line.Distances) == 1 {
		return &axisgatev1.Segment{Speed: speed, Shape: &axisgatev1.Segment_Single{Single: line.Distances[0]}}, nil
	}
	return &axisgatev1.Segment{Speed: speed, Shape: &axisgatev1.Segment_Line{Line: line}}, nil
}

// runPath sends a path once, and returns the motion once it has started. The path continues without the call.
func (s *deviceSession) runPath(ctx context.Context, header *axisgatev1.PathHeader,
	segments []*axisgatev1.Segment) (*axisgatev1.Motion, error) {
	call, err := s.stages.RunPath(ctx)
	if err != nil {
		return nil, err
	}
	// A failed Send means that the call has ended; Recv says why.
	err = call.Send(&axisgatev1.RunPathRequest{Part: &axisgatev1.RunPathRequest_Header{Header: header}})
	for i := 0; i < len(segments) && err == nil; i++ {
		err = call.Send(&axisgatev1.RunPathRequest{Part: &axisgatev1.RunPathRequest_Segment{Segment: segments[i]}})
	}
	if err == nil {
		err = call.CloseSend()
	}
	for {
		answer, failed := call.Recv()
		if failed != nil {
			return nil, failed
		}
		if motion := answer.GetMotion(); motion != nil {
			return motion, err
		}
	}
}
