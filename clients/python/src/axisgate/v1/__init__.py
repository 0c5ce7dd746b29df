"""The generated messages and stubs of the API `axisgate.v1`, for calls that this package has no method for."""
