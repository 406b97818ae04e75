"""`spin_until_future_complete` with futures of `asyncio` and of `concurrent.futures`."""

import asyncio
import concurrent.futures
import json

import rclpy


def main():
    rclpy.init()
    node = rclpy.create_node("futures")
    results = []
    loop = asyncio.new_event_loop()
    for number, future in enumerate((asyncio.Future(loop=loop), concurrent.futures.Future())):
        timer = node.create_timer(0.1, lambda future=future, number=number: future.set_result(number))
        rclpy.spin_until_future_complete(node, future, timeout_sec=5.0)
        timer.cancel()
        results.append(future.result())
    late = asyncio.Future(loop=loop)
    rclpy.spin_until_future_complete(node, late, timeout_sec=0.1)
    results.append(late.done())
    loop.close()
    print(json.dumps({"results": results}))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
