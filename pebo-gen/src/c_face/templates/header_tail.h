/*
 * Sets an observer, before its first sample, with the settings of the model.
 *
 * Faults: POINTER; PARAMETER, CONSTANT; LIMITS to START only where rounding moves a setting of the
 * model out of its range.
 */
@name@_fault @name@_new(@name@ *observer@parameters@);

/*
 * Takes a sample, and gives the estimate of the states at its instant. `period` is the time since the
 * last accepted sample, in seconds.
@limits@ *
 * Faults: POINTER, NOT_SET; OUTPUT to GAP of this sample; SINGULAR, STATE, ESTIMATE.
 */
@name@_fault @name@_step(@name@ *observer, const @name@_y *y, @inputs@@c_scalar@ period, @name@_x *estimate);

/*
 * The estimate of the states at the last accepted sample.
 *
 * Faults: POINTER, NOT_SET, NO_ESTIMATE.
 */
@name@_fault @name@_estimate(const @name@ *observer, @name@_x *estimate);

@standard_error@/*
 * Starts again before the first sample, as after an outage that no period can bridge: from the start
 * of the model's settings, with these parameters and gains.
 *
 * Faults: POINTER, NOT_SET.
 */
@name@_fault @name@_restart(@name@ *observer);

#ifdef __cplusplus
}
#endif

#endif
