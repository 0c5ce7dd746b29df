package axisgate

import (
	"context"
	"strings"
	"time"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// saveTime is the time that saving may wait for the end of a running motion.
const saveTime = 20 * time.Second

// Places are the saved positions of a stage, by name.
type Places struct{ session *deviceSession }

// Save saves the present position. It stays the same place when coordinates are set again.
func (p *Places) Save(ctx context.Context, name string) error {
	return p.save(ctx, name, axisgatev1.PositionKind_POSITION_KIND_PLACE)
}

// SaveCoordinates saves the coordinates of the present position. They stay the same when coordinates are set again.
func (p *Places) SaveCoordinates(ctx context.Context, name string) error {
	return p.save(ctx, name, axisgatev1.PositionKind_POSITION_KIND_COORDINATES)
}

func (p *Places) save(ctx context.Context, name string, kind axisgatev1.PositionKind) error {
	request := &axisgatev1.SavePositionRequest{Position: p.resource(name), Kind: kind}
	_, err := change(ctx, p.session, p.session.positions.SavePosition, request, saveTime)
	return err
}

// MoveTo moves all axes to a saved position, and waits for the outcome. The end of ctx cancels the move.
func (p *Places) MoveTo(ctx context.Context, name string) (*Result, error) {
	request := &axisgatev1.MoveToPositionRequest{Position: p.resource(name)}
	return p.session.finish(ctx, func(ctx context.Context) (*Motion, error) {
		return start(ctx, p.session, p.session.positions.MoveToPosition, request)
	})
}

// Delete deletes a saved position.
func (p *Places) Delete(ctx context.Context, name string) error {
	request := &axisgatev1.DeletePositionRequest{Position: p.resource(name)}
	_, err := change(ctx, p.session, p.session.positions.DeletePosition, request, 0)
	return err
}

// List returns the saved positions by name, with the positions of the axes when they were saved.
func (p *Places) List(ctx context.Context) (map[string][]Position, error) {
	listed, err := ask(ctx, p.session.connection, p.session.positions.ListPositions,
		&axisgatev1.ListPositionsRequest{Device: p.session.device}, p.session.half)
	if err != nil {
		return nil, err
	}
	places := map[string][]Position{}
	for _, place := range listed.Positions {
		name := place.Name[strings.LastIndexByte(place.Name, '/')+1:]
		for _, one := range place.Coordinates {
			places[name] = append(places[name],
				Position{axisName(one.Name, one.Axis), one.Position, unitOf(one.Unit), &one.Pulses})
		}
	}
	return places, nil
}

func (p *Places) resource(name string) string { return p.session.device + "/positions/" + name }
