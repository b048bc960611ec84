/* Observers of two models in one program. */
#include <stdio.h>

#include "cuk.h"
#include "dc_motor.h"

int main(void)
{
    static cuk converter;
    static dc_motor motor;
    static const cuk_parameters of_converter = CUK_PARAMETERS;
    static const dc_motor_parameters of_motor = DC_MOTOR_PARAMETERS;
    const cuk_y voltages = {10.0, -12.0};
    const cuk_u duty = {0.68};
    const dc_motor_y speed = {0.0};
    const dc_motor_u voltage = {12.0};
    cuk_x currents;
    dc_motor_x load;

    if (cuk_new(&converter, &of_converter) != CUK_OK || dc_motor_new(&motor, &of_motor) != DC_MOTOR_OK) {
        printf("an observer is not set\n");
        return 1;
    }
    if (cuk_step(&converter, &voltages, &duty, 1e-5, &currents) != CUK_OK ||
        dc_motor_step(&motor, &speed, &voltage, 1e-4, &load) != DC_MOTOR_OK) {
        printf("a sample is refused\n");
        return 1;
    }
    if (dc_motor_restart((dc_motor *)(void *)&converter) != DC_MOTOR_FAULT_NOT_SET) {
        printf("an observer of another model is taken\n");
        return 1;
    }
    printf("as expected\n");
    return 0;
}
