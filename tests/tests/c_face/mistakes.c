/* Mistakes of a program with the observer of the model `cart`: the fault of each, and what the observer does after. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cart.h"

static int failures;

static void expect(int line, cart_fault found, cart_fault wanted)
{
    if (found != wanted) {
        printf("line %d: fault %d in place of %d\n", line, (int)found, (int)wanted);
        failures++;
    }
}

#define EXPECT(call, wanted) expect(__LINE__, call, wanted)

static int same(const cart *a, const cart *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

int main(void)
{
    static cart observer;
    static cart before;
    static const cart_parameters parameters = CART_PARAMETERS;
    cart_parameters wrong = CART_PARAMETERS;
    cart_y y = {0.0f, 0.5f};
    cart_y bad = {0.0f, 0.5f};
    cart_u u = {20.0f};
    cart_x x = {0.0f, 0.0f, 0.0f};
    cart_x again = {1.0f, 1.0f, 1.0f};
    int sample;

    /* Memory that is zero holds no observer. */
    EXPECT(cart_step(&observer, &y, &u, 0.01f, &x), CART_FAULT_NOT_SET);
    EXPECT(cart_estimate(&observer, &x), CART_FAULT_NOT_SET);
    EXPECT(cart_standard_error(&observer, &x), CART_FAULT_NOT_SET);
    EXPECT(cart_restart(&observer), CART_FAULT_NOT_SET);

    EXPECT(cart_new(NULL, &parameters), CART_FAULT_POINTER);
    EXPECT(cart_new(&observer, NULL), CART_FAULT_POINTER);
    wrong.m = -1.0f;
    EXPECT(cart_new(&observer, &wrong), CART_FAULT_PARAMETER);
    EXPECT(cart_restart(&observer), CART_FAULT_NOT_SET);
    EXPECT(cart_new(&observer, &parameters), CART_OK);
    EXPECT(cart_estimate(&observer, &x), CART_FAULT_NO_ESTIMATE);
    EXPECT(cart_standard_error(&observer, &x), CART_FAULT_NO_ESTIMATE);

    for (sample = 0; sample < 50; sample++) {
        EXPECT(cart_step(&observer, &y, &u, 0.01f, &x), CART_OK);
    }
    EXPECT(cart_estimate(&observer, &again), CART_OK);
    if (memcmp(&x, &again, sizeof x) != 0) {
        printf("the estimate is another one\n");
        failures++;
    }
    EXPECT(cart_standard_error(&observer, &again), CART_OK);
    if (!(again.v > 0.0f && again.slope > 0.0f && again.bias > 0.0f)) {
        printf("a standard error is not positive\n");
        failures++;
    }

    before = observer;
    EXPECT(cart_step(NULL, &y, &u, 0.01f, &x), CART_FAULT_POINTER);
    EXPECT(cart_step(&observer, NULL, &u, 0.01f, &x), CART_FAULT_POINTER);
    EXPECT(cart_step(&observer, &y, NULL, 0.01f, &x), CART_FAULT_POINTER);
    EXPECT(cart_step(&observer, &y, &u, 0.01f, NULL), CART_FAULT_POINTER);
    EXPECT(cart_step(&observer, &y, &u, 0.0f, &x), CART_FAULT_STEP);
    EXPECT(cart_step(&observer, &y, &u, NAN, &x), CART_FAULT_STEP);
    bad.acc = NAN;
    EXPECT(cart_step(&observer, &bad, &u, 0.01f, &x), CART_FAULT_OUTPUT);
    bad.acc = 0.5f;
    bad.p = 200.0f;
    EXPECT(cart_step(&observer, &bad, &u, 0.01f, &x), CART_FAULT_OUTPUT_RANGE);
    u.F = 51.0f;
    EXPECT(cart_step(&observer, &y, &u, 0.01f, &x), CART_FAULT_INPUT_RANGE);
    u.F = 20.0f;
    EXPECT(cart_step(&observer, &y, &u, 2.0f, &x), CART_FAULT_GAP);
    if (!same(&observer, &before)) {
        printf("a refused sample has changed the observer\n");
        failures++;
    }
    bad.p = 50.0f;
    EXPECT(cart_step(&observer, &bad, &u, 0.01f, &x), CART_FAULT_OUTLIER);

    /* It goes on, from a copy too, and starts again. */
    EXPECT(cart_step(&observer, &y, &u, 0.01f, &x), CART_OK);
    EXPECT(cart_step(&before, &y, &u, 0.01f, &again), CART_OK);
    if (memcmp(&x, &again, sizeof x) != 0) {
        printf("a copy goes on otherwise\n");
        failures++;
    }
    EXPECT(cart_restart(&observer), CART_OK);
    EXPECT(cart_estimate(&observer, &x), CART_FAULT_NO_ESTIMATE);
    /* Before the first sample no interval is too long. */
    EXPECT(cart_step(&observer, &y, &u, 2.0f, &x), CART_OK);

    if (failures == 0) {
        printf("as expected\n");
    }
    return failures != 0;
}
