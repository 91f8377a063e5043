"""What puts a swarm on computers: systemd units and a container file. The guide: docs/machines.md."""
