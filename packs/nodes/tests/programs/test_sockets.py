"""Sockets of programs wait in simulated time."""

from __future__ import annotations

from collections.abc import Callable

Run = Callable[..., list[str]]


def test_a_server_and_its_client_in_two_threads_wait_for_each_other(run_program: Run) -> None:
    log = run_program(
        """
        import socket, threading, time

        def serve():
            connection, _ = server.accept()
            print(connection.recv(10), round(time.time(), 1))
            time.sleep(0.2)
            connection.sendall(b"answer")
            connection.close()

        server = socket.create_server(("127.0.0.1", 0))
        thread = threading.Thread(target=serve)
        thread.start()
        time.sleep(0.1)
        client = socket.create_connection(server.getsockname())
        client.sendall(b"question")
        with client, server, client.makefile("rb") as answers:
            print(answers.read(), round(time.time(), 1))
        """
    )
    assert log == ["b'question' 0.1", "b'answer' 0.3"]


def test_a_socket_without_data_holds_up_neither_the_simulation_nor_other_threads(run_program: Run) -> None:
    log = run_program(
        """
        import socket, threading, time

        def receive(timeout):
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
                receiver.bind(("127.0.0.1", 0))
                receiver.settimeout(timeout)
                try:
                    receiver.recvfrom(1024)
                except socket.timeout as error:
                    print(error, round(time.time(), 2))

        threading.Thread(target=receive, args=(None,), daemon=True).start()
        receive(0.25)
        """
    )
    assert log == ["timed out 0.25"]


def test_a_refused_connection_has_the_error_of_python(run_program: Run) -> None:
    log = run_program(
        """
        import socket

        unused = socket.create_server(("127.0.0.1", 0))
        address = unused.getsockname()
        unused.close()
        try:
            socket.create_connection(address, timeout=1.0)
        except ConnectionRefusedError as error:
            print(type(error).__name__)
        """
    )
    assert log == ["ConnectionRefusedError"]
