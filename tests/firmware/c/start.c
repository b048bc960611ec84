/*
 * What a program in C needs before `main` on the board: the vectors, and the floating-point unit. The rest, and printing
 * by semihosting, is the C library's (newlib with rdimon.specs).
 */
#include <stdint.h>

typedef void (*handler)(void);

void _start(void);
void reset(void);
void stopped(void);

/* Behind the start of the stack, which the linker script puts in front. */
__attribute__((section(".vectors"), used)) static const handler vectors[15] = {
    reset, stopped, stopped, stopped, stopped, stopped, 0, 0, 0, 0, stopped, stopped, 0, stopped, stopped,
};

void reset(void)
{
    /* Full access to the coprocessors 10 and 11, before an instruction of theirs. */
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20;
    __asm volatile("dsb\n\tisb");
    _start();
}

void stopped(void)
{
    for (;;) {
    }
}
