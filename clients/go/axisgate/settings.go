package axisgate

import (
	"context"
	"time"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// changeTime is the time for which a change of settings may wait for running commands.
const changeTime = 20 * time.Second

// Settings reads the settings of the stage from the controller, as the API's message.
func (s *Stage) Settings(ctx context.Context) (*axisgatev1.Settings, error) {
	answer, err := ask(ctx, s.session.connection, s.session.settings.GetSettings,
		&axisgatev1.GetSettingsRequest{Device: s.session.device}, s.session.half)
	if err != nil {
		return nil, err
	}
	return answer.Settings, nil
}

// ChangeSettings changes the settings that are set in the API's message, and no others. Speeds, outputs and the trigger
// that are set under a lease return to their values after it.
func (s *Stage) ChangeSettings(ctx context.Context, settings *axisgatev1.Settings) error {
	request := &axisgatev1.ChangeSettingsRequest{Device: s.session.device, Settings: settings}
	_, err := change(ctx, s.session, s.session.settings.ChangeSettings, request, changeTime)
	return err
}
