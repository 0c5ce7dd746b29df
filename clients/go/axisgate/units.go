package axisgate

import (
	"fmt"
	"math"
	"reflect"
	"regexp"
	"strconv"
	"strings"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

// A Unit is the unit of a distance, as its symbol. A unit of a newer daemon is "UNIT 9".
type Unit string

// Units of distances.
const (
	UnitPulses      Unit = "pulses"
	UnitNanometers  Unit = "nm"
	UnitMicrometers Unit = "um"
	UnitMillimeters Unit = "mm"
	UnitDegrees     Unit = "deg"
)

// A Number is the number of a distance. A text and an integer are exact: the daemon refuses an amount that is not a
// whole number of pulses. A floating-point number becomes the nearest whole number of pulses, and the result of the
// motion says which.
type Number interface {
	~string | ~int | ~int32 | ~int64 | ~float32 | ~float64
}

// A Distance is a position or a displacement. Its zero value is no distance.
type Distance struct{ amount amount }

// A Speed is a distance for each second. A jog in the minus direction has a negative speed. Its zero value is no speed.
type Speed struct{ amount amount }

// NM returns a distance in nanometres.
func NM[N Number](number N) Distance { return distanceOf(number, UnitNanometers) }

// UM returns a distance in micrometres.
func UM[N Number](number N) Distance { return distanceOf(number, UnitMicrometers) }

// MM returns a distance in millimetres.
func MM[N Number](number N) Distance { return distanceOf(number, UnitMillimeters) }

// Deg returns a distance in degrees, for a rotary axis.
func Deg[N Number](number N) Distance { return distanceOf(number, UnitDegrees) }

// Pulses returns a distance in drive pulses, the smallest step of an axis.
func Pulses[N Number](number N) Distance { return distanceOf(number, UnitPulses) }

// PerSecond returns the speed of this distance in each second.
func (d Distance) PerSecond() Speed { return Speed(d) }

// Neg returns the opposite distance.
func (d Distance) Neg() Distance { return Distance{d.amount.neg()} }

// Neg returns the speed in the opposite direction.
func (s Speed) Neg() Speed { return Speed{s.amount.neg()} }

// String returns the distance with its unit: "1.5 mm".
func (d Distance) String() string { return d.amount.String() }

// String returns the speed with its unit: "1.5 mm/s".
func (s Speed) String() string { return s.amount.String() + "/s" }

// An amount is a number with its unit. If isFloat, the number is `float`; otherwise it is `text`.
type amount struct {
	text    string
	float   float64
	isFloat bool
	unit    Unit
}

func distanceOf[N Number](number N, unit Unit) Distance {
	switch value := reflect.ValueOf(number); value.Kind() {
	case reflect.String:
		return Distance{amount{text: strings.TrimSpace(value.String()), unit: unit}}
	case reflect.Float32, reflect.Float64:
		return Distance{amount{float: value.Float(), isFloat: true, unit: unit}}
	default:
		return Distance{amount{text: strconv.FormatInt(value.Int(), 10), unit: unit}}
	}
}

var decimal = regexp.MustCompile(`^[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?$`)

// check returns an InvalidArgument unless the amount is a finite number with a unit.
func (a amount) check() error {
	switch {
	case a.unit == "":
		return invalid("an amount is missing: write a number with its unit, such as axisgate.MM(\"1.5\")")
	case a.isFloat && (math.IsNaN(a.float) || math.IsInf(a.float, 0)):
		return invalid("%v is not an amount: it must be a finite number", a.float)
	case !a.isFloat && !decimal.MatchString(a.text):
		return invalid("%q is not a decimal number", a.text)
	}
	return nil
}

func (a amount) neg() amount {
	a.float = -a.float
	if rest, minus := strings.CutPrefix(a.text, "-"); minus {
		a.text = rest
	} else {
		a.text = "-" + strings.TrimPrefix(a.text, "+")
	}
	return a
}

func (a amount) negative() bool {
	return a.float < 0 || (!a.isFloat && strings.HasPrefix(a.text, "-"))
}

// pulses returns the text as a whole number of pulses.
func (a amount) pulses() (int64, error) {
	count, err := strconv.ParseInt(a.text, 10, 64)
	if err != nil {
		return 0, invalid("%s is not a whole number of pulses", a.text)
	}
	return count, nil
}

func (a amount) String() string {
	if a.isFloat {
		return fmt.Sprintf("%v %s", a.float, a.unit)
	}
	return a.text + " " + string(a.unit)
}

var unitNumbers = map[Unit]axisgatev1.Unit{
	UnitPulses:      axisgatev1.Unit_UNIT_PULSES,
	UnitNanometers:  axisgatev1.Unit_UNIT_NANOMETERS,
	UnitMicrometers: axisgatev1.Unit_UNIT_MICROMETERS,
	UnitMillimeters: axisgatev1.Unit_UNIT_MILLIMETERS,
	UnitDegrees:     axisgatev1.Unit_UNIT_DEGREES,
}

func unitOf(number axisgatev1.Unit) Unit {
	for unit, known := range unitNumbers {
		if known == number {
			return unit
		}
	}
	return Unit(fmt.Sprintf("UNIT %d", number))
}

func (a amount) floating() *axisgatev1.FloatingAmount {
	return &axisgatev1.FloatingAmount{Value: a.float, Unit: unitNumbers[a.unit],
		Rounding: axisgatev1.Rounding_ROUNDING_NEAREST}
}

// message returns the API's message of a distance.
func (d Distance) message() (*axisgatev1.Distance, error) {
	a := d.amount
	if err := a.check(); err != nil {
		return nil, err
	}
	if a.isFloat {
		return &axisgatev1.Distance{Amount: &axisgatev1.Distance_Floating{Floating: a.floating()}}, nil
	}
	switch a.unit {
	case UnitNanometers:
		return &axisgatev1.Distance{Amount: &axisgatev1.Distance_Nm{Nm: a.text}}, nil
	case UnitMicrometers:
		return &axisgatev1.Distance{Amount: &axisgatev1.Distance_Um{Um: a.text}}, nil
	case UnitMillimeters:
		return &axisgatev1.Distance{Amount: &axisgatev1.Distance_Mm{Mm: a.text}}, nil
	case UnitDegrees:
		return &axisgatev1.Distance{Amount: &axisgatev1.Distance_Degrees{Degrees: a.text}}, nil
	}
	count, err := a.pulses()
	return &axisgatev1.Distance{Amount: &axisgatev1.Distance_Pulses{Pulses: count}}, err
}

// message returns the API's message of a speed.
func (s Speed) message() (*axisgatev1.Speed, error) {
	a := s.amount
	if err := a.check(); err != nil {
		return nil, err
	}
	if a.isFloat {
		return &axisgatev1.Speed{Amount: &axisgatev1.Speed_Floating{Floating: a.floating()}}, nil
	}
	switch a.unit {
	case UnitNanometers:
		return &axisgatev1.Speed{Amount: &axisgatev1.Speed_NmPerS{NmPerS: a.text}}, nil
	case UnitMicrometers:
		return &axisgatev1.Speed{Amount: &axisgatev1.Speed_UmPerS{UmPerS: a.text}}, nil
	case UnitMillimeters:
		return &axisgatev1.Speed{Amount: &axisgatev1.Speed_MmPerS{MmPerS: a.text}}, nil
	case UnitDegrees:
		return &axisgatev1.Speed{Amount: &axisgatev1.Speed_DegreesPerS{DegreesPerS: a.text}}, nil
	}
	count, err := a.pulses()
	return &axisgatev1.Speed{Amount: &axisgatev1.Speed_PulsesPerS{PulsesPerS: count}}, err
}

// optional returns the API's message of a speed. nil: the present speed of the axis.
func (s Speed) optional() (*axisgatev1.Speed, error) {
	if s == (Speed{}) {
		return nil, nil
	}
	return s.message()
}
