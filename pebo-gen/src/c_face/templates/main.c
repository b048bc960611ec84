/*
 * Steps the observer of the model `@model@` over samples of
 * @origin@, and prints each estimate,
 * in brackets with all its digits. Written by pebo-gen @version@.
 */
#include <stddef.h>
#include <stdio.h>

#include "@name@.h"

/* The time since the sample before, the outputs at its end, the inputs during it. */
static const struct {
    @c_scalar@ period;
    @name@_y y;
@u_field@} samples[] = {
@rows@};

static void print(const char *name, double value)
{
    printf("  %s = %.6g (%.@digits@g)", name, value, value);
}

/* Zero before it is set, and of a size that the compiler knows. */
static @name@ observer;

int main(void)
{
@parameters_value@    double time = 0.0;
    size_t k;
    @name@_fault fault = @name@_new(&observer@parameters@);

    if (fault != @NAME@_OK) {
        fprintf(stderr, "@name@_new: fault %d\n", (int)fault);
        return 1;
    }
    for (k = 0; k < sizeof samples / sizeof samples[0]; k++) {
        @name@_x x;

        time += k == 0 ? 0.0 : (double)samples[k].period;
        fault = @name@_step(&observer, &samples[k].y, @u@samples[k].period, &x);
        printf("%.6g s:", time);
        if (fault == @NAME@_OK) {
@prints@            printf("\n");
        } else {
            printf("  fault %d\n", (int)fault);
        }
    }
    return 0;
}
