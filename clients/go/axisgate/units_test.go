package axisgate

import (
	"errors"
	"math"
	"testing"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

func TestExactAmounts(t *testing.T) {
	for _, test := range []struct {
		distance Distance
		wanted   *axisgatev1.Distance
	}{
		{MM("1.5"), &axisgatev1.Distance{Amount: &axisgatev1.Distance_Mm{Mm: "1.5"}}},
		{MM(2), &axisgatev1.Distance{Amount: &axisgatev1.Distance_Mm{Mm: "2"}}},
		{UM(int64(-7)), &axisgatev1.Distance{Amount: &axisgatev1.Distance_Um{Um: "-7"}}},
		{NM(" 1e3 "), &axisgatev1.Distance{Amount: &axisgatev1.Distance_Nm{Nm: "1e3"}}},
		{Deg("-.5").Neg(), &axisgatev1.Distance{Amount: &axisgatev1.Distance_Degrees{Degrees: ".5"}}},
		{Pulses(5), &axisgatev1.Distance{Amount: &axisgatev1.Distance_Pulses{Pulses: 5}}},
	} {
		message, err := test.distance.message()
		if err != nil || message.String() != test.wanted.String() {
			t.Errorf("%s is %v, %v", test.distance, message, err)
		}
	}
}

func TestFloatingAmountsAreRoundedByTheDaemon(t *testing.T) {
	message, err := MM(0.1 + 0.2).message()
	floating := message.GetFloating()
	if err != nil || floating.GetValue() != 0.1+0.2 || floating.GetUnit() != axisgatev1.Unit_UNIT_MILLIMETERS ||
		floating.GetRounding() != axisgatev1.Rounding_ROUNDING_NEAREST {
		t.Errorf("%v, %v", message, err)
	}
	speed, err := UM(-1.5).PerSecond().Neg().message()
	if err != nil || speed.GetFloating().GetValue() != 1.5 {
		t.Errorf("%v, %v", speed, err)
	}
}

func TestAmountsThatAreNone(t *testing.T) {
	for _, wrong := range []Distance{{}, MM(math.NaN()), MM(math.Inf(-1)), MM("nan"), MM(""), MM("1,5"), MM("0x1"),
		Pulses("1.5"), Pulses("x")} {
		_, err := wrong.message()
		_, speedErr := wrong.PerSecond().message()
		var argument *InvalidArgument
		if !errors.As(err, &argument) || !errors.As(speedErr, &argument) {
			t.Errorf("%v: %v, %v", wrong, err, speedErr)
		}
	}
}

func TestTextOfAmounts(t *testing.T) {
	for amount, wanted := range map[interface{ String() string }]string{
		MM("1.50"): "1.50 mm", UM(2.5): "2.5 um", Pulses(-3).PerSecond(): "-3 pulses/s"} {
		if amount.String() != wanted {
			t.Errorf("%s, not %s", amount, wanted)
		}
	}
}

func TestDirectionOfAJog(t *testing.T) {
	for _, speed := range []Speed{UM("-2").PerSecond(), UM(2).Neg().PerSecond(), UM(-2.0).PerSecond()} {
		jog, err := axisJog("x", speed)
		if err != nil || jog.Direction != axisgatev1.AxisJog_DIRECTION_MINUS ||
			(jog.Speed.GetUmPerS() != "2" && jog.Speed.GetFloating().GetValue() != 2) {
			t.Errorf("%v: %v, %v", speed, jog, err)
		}
	}
}
